#include "master/diagnostics/map.h"

#include <time.h>

#include <algorithm>
#include <cassert>
#include <mutex>

#include "common/work/each_tile.h"

namespace rayfarm {
namespace {

/// That the thread has had of a processor: what else the PC does is no part of it.
double thread_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

void fill(Map& map, const Tile& tile, int pass, Pixel pixel, const float* value) {
  const std::uint32_t stride = pass_stride[static_cast<std::size_t>(pass)];
  const std::uint32_t x1 = std::min(pixel.x + stride, tile.x1), y1 = std::min(pixel.y + stride, tile.y1);
  for (std::uint32_t y = pixel.y; y < y1; ++y)
    for (std::uint32_t x = pixel.x; x < x1; ++x)
      std::copy_n(value, map.channels, &map.values[(std::size_t{y} * map.size.width + x) * map.channels]);
}

MapView view_of(const World& world, const RenderSettings& settings, bool compatible) {
  const CameraRays camera(world.scene().camera, {settings.width, settings.height});
  return {camera.axes(), camera.from(), compatible};
}

PixelMapper::PixelMapper(const World& world, const RenderSettings& settings, const MapRequest& request)
    : settings_(settings),
      request_(request),
      view_(view_of(world, settings, request.compatible)),
      tracer_(world, settings),
      watch_(world, settings, request.reduction) {
  assert(request.kind->put && "the farm has the values of this map");
  tracer_.set_watch(&watch_);
}

std::optional<PixelFacts> PixelMapper::facts(Pixel pixel, const std::function<bool()>& stop) {
  // Where an adaptive sampler puts its samples depends on all that they show.
  const bool first_hits_do = request_.kind->source == MapSource::surfaces && !is_adaptive(settings_.sampler);
  watch_.pixel_begins(tracer_.observer.counters);
  const bool is_timed = request_.kind->source == MapSource::time;  // to ask for the time is a system call
  const double begin = is_timed ? thread_seconds() : 0;
  const bool complete =
      first_hits_do ? trace_first_hits(pixel, stop) : pixel_sum(tracer_, settings_, pixel, stop).has_value();
  if (!complete) return std::nullopt;
  PixelFacts facts = watch_.facts(tracer_.observer.counters);
  if (is_timed) facts.seconds = thread_seconds() - begin;
  return facts;
}

bool PixelMapper::put(Pixel pixel, float* into, const std::function<bool()>& stop) {
  const std::optional<PixelFacts> known = facts(pixel, stop);
  if (known) request_.kind->put(*known, view_, into);
  return known.has_value();
}

bool PixelMapper::trace_first_hits(Pixel pixel, const std::function<bool()>& stop) {
  constexpr std::uint32_t samples_between_questions = 256;
  const PixelSampler sampler(settings_, pixel);
  for (std::uint32_t s = 0; s < settings_.spp; ++s) {
    if (s % samples_between_questions == 0 && stop()) return false;
    const Sample2D place = sampler.sample(s, 0);
    const std::optional<Hit> hit = tracer_.first_hit(pixel.x + place.u, pixel.y + place.v);
    tracer_.observer.traced(RayKind::primary, {}, 0, 1, hit);
    watch_.ray_ended(hit);
  }
  return true;
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
