#include "master/diagnostics/diagnostics.h"

namespace rayfarm {
namespace {

Size size_of(const RenderSettings& settings) { return {settings.width, settings.height}; }

/// What has no bearing on the values is as by default, so that equal maps have equal requests.
MapRequest essence_of(const MapRequest& request) {
  MapRequest essence{request.kind};
  if (request.kind->reduces) essence.reduction = request.reduction;
  if (request.kind->has_compatible) essence.compatible = request.compatible;
  return essence;
}

/// The other maps that follow from the samples of one: where the primary rays end.
std::vector<MapRequest> kin_of(const MapRequest& request) {
  std::vector<MapRequest> kin;
  if (request.kind->source != MapSource::surfaces) return kin;
  for (const MapKind& kind : all_maps()) {
    const MapRequest other = essence_of({&kind, request.reduction, request.compatible});
    if (kind.source == MapSource::surfaces && !(other == request)) kin.push_back(other);
  }
  return kin;
}

std::uint64_t bytes_of(const RenderSettings& settings, const MapRequest& request) {
  return std::uint64_t{settings.width} * settings.height * request.kind->channels.size() * sizeof(float);
}

/// The values of a pass of a tile for one map, in their travelling order.
struct PassOfMap {
  MapRequest request;
  MapView view;
  std::vector<float> values{};
};

/// Fills in the values of all maps from the same samples; false when stopped.
bool trace_pass(PixelMapper& mapper, const Tile& tile, int pass, std::vector<PassOfMap>& maps,
                const Background::Stop& stop) {
  for (PassOfMap& map : maps) map.values.reserve(pixel_count(tile, pass) * map.request.kind->channels.size());
  bool stopped = false;
  for_each_pixel(tile, pass, [&](std::uint32_t x, std::uint32_t y) {
    if (stopped) return;
    const std::optional<PixelFacts> facts = mapper.facts({x, y}, stop);
    stopped = !facts;
    for (PassOfMap& map : maps) {
      if (stopped) return;
      const std::size_t place = map.values.size();
      map.values.resize(place + map.request.kind->channels.size());
      map.request.kind->put(*facts, map.view, &map.values[place]);
    }
  });
  return !stopped;
}

template <class Thing>
Made<Thing> made(Standing standing, std::shared_ptr<const Thing> thing) {
  if (standing.state != LayerProgress::done) thing.reset();
  return {std::move(standing), std::move(thing)};
}

}  // namespace

Diagnostics::Diagnostics(unsigned threads, Clock now, const DiagnosticsLimits& limits)
    : worlds_(limits.worlds),
      maps_(limits.maps, now),
      statistics_(limits.statistics, now),
      clouds_(limits.clouds, now),
      background_(threads, now) {}

Diagnostics::~Diagnostics() = default;

std::shared_ptr<const ReadyScene> Diagnostics::scene(const Subject& subject) {
  return worlds_.get({subject.scene_hash, subject.scene}, subject.assets);
}

PixelTrace Diagnostics::trace(const Subject& subject, Pixel pixel, const SampleChoice& choice,
                              std::uint32_t story_ray) {
  const auto ready = scene(subject);
  const LeafNames names(ready, &ready->leaf_names());
  return pixel_trace(ready->world(), names, subject.settings, pixel, choice, story_ray,
                     {most_rays_recorded, [this] { return stopping_.load(); }});
}

void Diagnostics::stop() {
  stopping_ = true;
  background_.stop();
}

// Maps. ----------------------------------------------------------------------------------------------------

std::shared_ptr<Diagnostics::InMaking<GrowingMap>> Diagnostics::map_in_making(const Subject& subject,
                                                                              const MapRequest& asked) {
  const MapRequest request = essence_of(asked);
  const RenderSettings& settings = subject.settings;
  bool is_new = false;
  const auto map = maps_.get({subject.scene_hash, settings, request}, bytes_of(settings, request), [&] {
    is_new = true;
    return new_map(subject, request);
  });
  if (!is_new) return map;
  for (const MapRequest& other : kin_of(request))
    maps_.offer({subject.scene_hash, settings, other}, bytes_of(settings, other),
                [&] { return new_map(subject, other); });
  return map;
}

std::shared_ptr<Diagnostics::InMaking<GrowingMap>> Diagnostics::new_map(const Subject& subject,
                                                                        const MapRequest& request) {
  const Size size = size_of(subject.settings);
  const auto map = std::make_shared<GrowingMap>(size, request.kind->channels.size());
  // All tiles coarse first, as one sees a picture come.
  const auto do_part = [this, subject, request, map, order = centre_first(size)](
                           std::uint32_t part, const Background::Stop& stop) {
    return make_part_of_map(subject, request, *map,
                            {order[part % order.size()], static_cast<int>(part / order.size())}, stop);
  };
  return std::make_shared<InMaking<GrowingMap>>(
      InMaking<GrowingMap>{map, background_.add({tile_count(size) * pass_count, do_part})});
}

bool Diagnostics::make_part_of_map(const Subject& subject, const MapRequest& request, GrowingMap& map,
                                   PassOfTile part, const Background::Stop& stop) {
  const auto [tile, pass] = part;
  if (map.has(tile, pass)) return true;  // it came with another one

  const auto ready = scene(subject);
  const World& world = ready->world();
  std::vector<std::shared_ptr<GrowingMap>> targets;
  std::vector<PassOfMap> maps{{request, view_of(world, subject.settings, request.compatible)}};
  for (const MapRequest& other : kin_of(request)) {
    const auto kin = maps_.find({subject.scene_hash, subject.settings, other});
    if (!kin || kin->product->has(tile, pass)) continue;
    targets.push_back(kin->product);
    maps.push_back({other, view_of(world, subject.settings, other.compatible)});
  }
  PixelMapper mapper(world, subject.settings, request);
  if (!trace_pass(mapper, tile_at(size_of(subject.settings), tile), pass, maps, stop)) return false;
  map.put(tile, pass, maps.front().values);
  for (std::size_t i = 0; i < targets.size(); ++i) targets[i]->put(tile, pass, maps[i + 1].values);
  return true;
}

LayerNews Diagnostics::map_news(const Subject& subject, const MapRequest& request,
                                const std::vector<PassSet>& known, std::uint32_t most_tiles) {
  const auto map = map_in_making(subject, request);
  const Standing standing = background_.ask(map->task);
  LayerNews news = map->product->news(known, most_tiles);
  news.state.state = standing.state;
  news.state.message = standing.message;
  return news;
}

Made<Map> Diagnostics::map(const Subject& subject, const MapRequest& request) {
  const auto map = map_in_making(subject, request);
  return made(background_.ask(map->task), std::shared_ptr<const Map>(map->product, &map->product->whole()));
}

Map Diagnostics::map_so_far(const Subject& subject, const MapRequest& request) {
  const auto map = map_in_making(subject, request);
  background_.ask(map->task);
  return map->product->so_far();
}

// Statistics. ----------------------------------------------------------------------------------------------

Made<Statistics> Diagnostics::statistics(const Subject& subject) {
  const std::uint64_t bytes = subject.scene->size();  // a leaf is more bytes in it than a number of hits
  const auto statistics = statistics_.get({subject.scene_hash, subject.settings, {}}, bytes, [&] {
    const auto growing = std::make_shared<GrowingStatistics>();
    const auto do_part = [this, subject, growing](std::uint32_t tile, const Background::Stop& stop) {
      const auto ready = scene(subject);
      const auto part = statistics_of_tile(ready->world(), subject.settings, tile, stop);
      if (!part) return false;
      const std::lock_guard lock(growing->mutex);
      growing->total += *part;
      return true;
    };
    return std::make_shared<InMaking<GrowingStatistics>>(InMaking<GrowingStatistics>{
        growing, background_.add({tile_count(size_of(subject.settings)), do_part})});
  });
  return made(background_.ask(statistics->task),
              std::shared_ptr<const Statistics>(statistics->product, &statistics->product->total));
}

// Clouds. --------------------------------------------------------------------------------------------------

Made<PlyFile> Diagnostics::cloud(const Subject& subject, const CloudRequest& request) {
  constexpr std::uint64_t bytes_of_point = 100;  // as text
  const std::uint64_t bytes = bytes_of_point * request.points;
  const auto cloud = clouds_.get({subject.scene_hash, subject.settings, request}, bytes, [&] {
    const auto growing = std::make_shared<GrowingCloud>();
    const auto do_part = [this, subject, request, growing](std::uint32_t, const Background::Stop& stop) {
      auto file = small_cloud(scene(subject)->world(), subject.settings, request.options, request.points,
                              stop, [&](double share) { growing->share = share; });
      if (file) growing->file = std::move(*file);
      return file.has_value();
    };
    return std::make_shared<InMaking<GrowingCloud>>(
        InMaking<GrowingCloud>{growing, background_.add({1, do_part})});
  });
  Standing standing = background_.ask(cloud->task);
  if (standing.state == LayerProgress::making) standing.share_done = cloud->product->share;
  return made(std::move(standing), std::shared_ptr<const PlyFile>(cloud->product, &cloud->product->file));
}

}  // namespace rayfarm
