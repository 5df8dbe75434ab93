#include "master/diagnostics/map.h"

#include <cassert>
#include <chrono>
#include <mutex>

#include "common/render/pixel.h"
#include "common/work/each_tile.h"

namespace rayfarm {
namespace {

MapView view_of(const World& world, const RenderSettings& settings, bool compatible) {
  const Size film{settings.width, settings.height};
  const CameraRays camera(world.scene().camera, film);
  return {axes_of(camera, film), camera.ray(0, 0).origin, compatible};
}

}  // namespace

CameraAxes axes_of(const CameraRays& camera, Size film) {
  const double x = film.width, y = film.height;
  const auto towards = [&](double px, double py) { return camera.ray(px, py).direction; };
  return {normalized(towards(x, y / 2) - towards(0, y / 2)),
          normalized(towards(x / 2, 0) - towards(x / 2, y)), towards(x / 2, y / 2)};
}

PixelMapper::PixelMapper(const World& world, const RenderSettings& settings, const MapRequest& request)
    : settings_(settings),
      world_(world.parts()),
      request_(request),
      view_(view_of(world, settings, request.compatible)),
      tracer_(world, settings) {
  assert(request.kind->put && "the farm has the values of this map");
}

bool PixelMapper::put(Pixel pixel, float* into, const std::function<bool()>& stop) {
  const std::optional<PixelFacts> facts =
      request_.kind->source == MapSource::surfaces ? surface_facts(pixel, stop) : ray_facts(pixel, stop);
  if (facts) request_.kind->put(*facts, view_, into);
  return facts.has_value();
}

std::optional<PixelFacts> PixelMapper::ray_facts(Pixel pixel, const std::function<bool()>& stop) {
  tracer_.observer = {};
  const auto begin = std::chrono::steady_clock::now();
  if (!pixel_sum(tracer_, settings_, pixel, stop)) return std::nullopt;
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  return PixelFacts{tracer_.observer.counters, std::nullopt, taken.count()};
}

std::optional<PixelFacts> PixelMapper::surface_facts(Pixel pixel, const std::function<bool()>& stop) {
  if (stop()) return std::nullopt;
  const PixelSampler sampler(settings_, pixel);
  std::vector<SurfaceSample> hits;
  for (std::uint32_t s = 0; s < settings_.spp; ++s) {
    const Sample2D place = sampler.sample(s, 0);
    if (const auto hit = tracer_.first_hit(pixel.x + place.u, pixel.y + place.v))
      hits.push_back(surface_sample(world_, *hit));
  }
  PixelFacts facts;
  facts.rays.primary = settings_.spp, facts.rays.primary_hits = hits.size();
  if (request_.kind->reduces) facts.surface = reduced(hits, settings_.spp, request_.reduction);
  return facts;
}

std::optional<Map> map_of(const World& world, const RenderSettings& settings, const MapRequest& request,
                          unsigned threads, const std::function<bool()>& stop,
                          const std::function<void(std::uint32_t done, std::uint32_t all)>& progress) {
  const Size film{settings.width, settings.height};
  Map map{film, request.kind->channels.size(), {}};
  map.values.resize(std::size_t{film.width} * film.height * map.channels);
  std::mutex mutex;
  std::uint32_t done = 0;  // guarded by the mutex; the map's pixels are each written by one thread
  const auto fill = [&](std::uint32_t number) {
    const Tile tile = tile_at(film, number);
    PixelMapper mapper(world, settings, request);
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y)
      for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
        const std::size_t place = (std::size_t{y} * film.width + x) * map.channels;
        if (!mapper.put({x, y}, &map.values[place], stop)) return false;
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
