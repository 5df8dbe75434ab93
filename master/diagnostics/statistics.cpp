#include "master/diagnostics/statistics.h"

#include <algorithm>
#include <mutex>

#include "common/render/pixel.h"
#include "common/work/each_tile.h"

namespace rayfarm {
namespace {

struct HitCounter : CountingObserver {
  std::vector<std::uint64_t> hits;

  void traced(RayKind kind, const Ray& ray, std::uint32_t depth, double importance,
              const std::optional<Hit>& hit) {
    CountingObserver::traced(kind, ray, depth, importance, hit);
    if (hit) ++hits[hit->leaf];
  }
};

}  // namespace

Statistics& Statistics::operator+=(const Statistics& other) {
  rays += other.rays;
  hits.resize(std::max(hits.size(), other.hits.size()));
  for (std::size_t leaf = 0; leaf < other.hits.size(); ++leaf) hits[leaf] += other.hits[leaf];
  return *this;
}

std::optional<Statistics> statistics_of_tile(const World& world, const RenderSettings& settings,
                                             std::uint32_t number, const std::function<bool()>& stop) {
  HitCounter counter;
  counter.hits.resize(world.parts().leaves.size());
  Tracer<HitCounter> tracer(world, settings, std::move(counter));
  const Tile tile = tile_at({settings.width, settings.height}, number);
  std::uint64_t bad_samples = 0;
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y)
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
      const auto sum = pixel_sum(tracer, settings, {x, y}, stop);
      if (!sum) return std::nullopt;
      bad_samples += sum->bad_samples;
    }
  Statistics result{tracer.observer.counters, std::move(tracer.observer.hits)};
  result.rays.bad_samples = bad_samples;
  return result;
}

std::optional<Statistics> statistics_of(
    const World& world, const RenderSettings& settings, unsigned threads, const std::function<bool()>& stop,
    const std::function<void(std::uint32_t done, std::uint32_t all)>& progress) {
  const Size film{settings.width, settings.height};
  std::mutex mutex;  // guards what follows
  Statistics total{{}, std::vector<std::uint64_t>(world.parts().leaves.size())};
  std::uint32_t done = 0;
  const auto count = [&](std::uint32_t tile) {
    const auto part = statistics_of_tile(world, settings, tile, stop);
    if (!part) return false;
    const std::lock_guard lock(mutex);
    total += *part;
    ++done;
    return true;
  };
  const auto show = [&] {
    const std::lock_guard lock(mutex);
    progress(done, tile_count(film));
  };
  if (!each_tile(film, threads, count, show)) return std::nullopt;
  return total;
}

}  // namespace rayfarm
