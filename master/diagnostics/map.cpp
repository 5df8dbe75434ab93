#include "master/diagnostics/map.h"

#include <chrono>
#include <initializer_list>
#include <mutex>

#include "common/render/pixel.h"
#include "common/work/each_tile.h"

namespace rayfarm {
namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

std::size_t channels_of(MapKind kind) {
  return kind == MapKind::normal || kind == MapKind::normal_camera ? 3 : 1;
}

/// Counts rays of every kind that hit something.
struct RayCountObserver : CountingObserver {
  std::uint64_t rays(bool with_shadow_rays) const {
    return counters.primary_hits + counters.secondary_hits + (with_shadow_rays ? counters.shadow : 0);
  }
};

/// The values of one pixel after another.
class Values {
 public:
  Values(const World& world, const RenderSettings& settings, const MapRequest& request)
      : world_(world),
        settings_(settings),
        request_(request),
        axes_(axes_of(camera_of(world, settings), {settings.width, settings.height})),
        eye_(camera_of(world, settings).ray(0, 0).origin),
        tracer_(world, settings) {}

  /// False when stopped.
  bool put(Pixel pixel, float* into, const std::function<bool()>& stop) {
    if (request_.kind == MapKind::all_rays || request_.kind == MapKind::cost)
      return put_traced(pixel, into, stop);
    if (stop()) return false;
    if (request_.kind == MapKind::samples) {
      *into = static_cast<float>(settings_.spp);
      return true;
    }
    const std::vector<SurfaceSample> hits = first_surfaces(pixel);
    if (request_.kind == MapKind::primary_rays) {
      *into = static_cast<float>(hits.size());
      return true;
    }
    const std::optional<Surface> surface = reduced(hits, settings_.spp, request_.reduction);
    if (request_.kind == MapKind::depth)
      *into = surface ? static_cast<float>(surface->distance) : nothing;
    else
      put_normal(surface, into);
    return true;
  }

 private:
  static CameraRays camera_of(const World& world, const RenderSettings& settings) {
    return {world.scene().camera, {settings.width, settings.height}};
  }

  bool put_traced(Pixel pixel, float* into, const std::function<bool()>& stop) {
    tracer_.observer = {};
    const auto begin = std::chrono::steady_clock::now();
    if (!pixel_sum(tracer_, settings_, pixel, stop)) return false;
    const std::chrono::duration<float> taken = std::chrono::steady_clock::now() - begin;
    *into = request_.kind == MapKind::cost ? taken.count()
                                           : static_cast<float>(tracer_.observer.rays(!request_.compatible));
    return true;
  }

  std::vector<SurfaceSample> first_surfaces(Pixel pixel) {
    const PixelSampler sampler(settings_, pixel);
    std::vector<SurfaceSample> hits;
    for (std::uint32_t s = 0; s < settings_.spp; ++s) {
      const Sample2D place = sampler.sample(s, 0);
      if (const auto hit = tracer_.first_hit(pixel.x + place.u, pixel.y + place.v))
        hits.push_back(surface_sample(world_.parts(), *hit));
    }
    return hits;
  }

  void put_normal(const std::optional<Surface>& surface, float* into) const {
    const Vec3d shown = surface ? normal_of(*surface) : Vec3d{infinity, infinity, infinity};
    for (int c = 0; c < 3; ++c) into[c] = static_cast<float>(shown[c]);
  }

  Vec3d normal_of(const Surface& s) const {
    if (request_.kind == MapKind::normal) return s.normal;
    if (request_.compatible) return normalized(eye_ - s.point - s.normal);
    return {dot(s.normal, axes_.right), dot(s.normal, axes_.up), dot(s.normal, axes_.forward)};
  }

  const World& world_;
  const RenderSettings& settings_;
  const MapRequest& request_;
  const CameraAxes axes_;
  const Vec3d eye_;
  Tracer<RayCountObserver> tracer_;
};

template <class Choice>
std::optional<Choice> named(std::string_view name,
                            std::initializer_list<std::pair<std::string_view, Choice>> names) {
  for (const auto& [known, choice] : names)
    if (known == name) return choice;
  return std::nullopt;
}

}  // namespace

CameraAxes axes_of(const CameraRays& camera, Size film) {
  const double x = film.width, y = film.height;
  const auto towards = [&](double px, double py) { return camera.ray(px, py).direction; };
  return {normalized(towards(x, y / 2) - towards(0, y / 2)),
          normalized(towards(x / 2, 0) - towards(x / 2, y)), towards(x / 2, y / 2)};
}

std::optional<MapKind> map_named(std::string_view name) {
  return named<MapKind>(name, {{"depth", MapKind::depth},
                               {"normal", MapKind::normal},
                               {"normal-camera", MapKind::normal_camera},
                               {"primary-rays", MapKind::primary_rays},
                               {"all-rays", MapKind::all_rays},
                               {"samples", MapKind::samples},
                               {"cost", MapKind::cost}});
}

std::optional<Reduction> reduction_named(std::string_view name) {
  return named<Reduction>(name, {{"majority", Reduction::majority},
                                 {"mean", Reduction::mean},
                                 {"closest", Reduction::closest},
                                 {"median", Reduction::median}});
}

std::optional<Map> map_of(const World& world, const RenderSettings& settings, const MapRequest& request,
                          unsigned threads, const std::function<bool()>& stop,
                          const std::function<void(std::uint32_t done, std::uint32_t all)>& progress) {
  const Size film{settings.width, settings.height};
  Map map{film, channels_of(request.kind), {}};
  map.values.resize(std::size_t{film.width} * film.height * map.channels);
  std::mutex mutex;
  std::uint32_t done = 0;  // guarded by the mutex; the map's pixels are each written by one thread
  const auto fill = [&](std::uint32_t number) {
    const Tile tile = tile_at(film, number);
    Values values(world, settings, request);
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y)
      for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
        const std::size_t place = (std::size_t{y} * film.width + x) * map.channels;
        if (!values.put({x, y}, &map.values[place], stop)) return false;
      }
    const std::lock_guard lock(mutex);
    ++done;
    return true;
  };
  const auto show = [&] {
    const std::lock_guard lock(mutex);
    progress(done, tile_count(film));
  };
  if (!each_tile(film, threads, fill, show)) return std::nullopt;
  return map;
}

}  // namespace rayfarm
