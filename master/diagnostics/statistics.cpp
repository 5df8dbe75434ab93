#include "master/diagnostics/statistics.h"

#include <algorithm>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>

#include "common/render/pixel.h"
#include "common/work/each_tile.h"

namespace rayfarm {
namespace {

/// Counts hits by leaf. It looks for each hit once more to count what that takes, so that who renders need not.
struct WorkCounter : CountingObserver {
  WorkCounter(const World& world) : world(&world.parts()), hits(world.parts().leaves.size()) {}

  void traced(RayKind kind, const Ray& ray, std::uint32_t depth, double importance,
              const std::optional<Hit>& hit) {
    CountingObserver::traced(kind, ray, depth, importance, hit);
    if (hit) ++hits[hit->leaf];
    first_boundary(*world, RayQuery(ray), nearest);
  }
  void shadow_tested(const Ray& ray, bool blocked) {
    CountingObserver::shadow_tested(ray, blocked);
    is_blocked(*world, RayQuery(ray), shadow);
  }

  const World::Parts* world;
  std::vector<std::uint64_t> hits;
  CountingWorkspace nearest, shadow;
};

nlohmann::json to_json(const RayTests& tests, std::uint64_t rays) {
  const double per_ray = rays > 0 ? 1.0 / static_cast<double>(rays) : 0;
  return {{"rays", rays},
          {"boxes", tests.boxes},
          {"leaves", tests.leaves},
          {"crossings", tests.crossings},
          {"boxes_per_ray", static_cast<double>(tests.boxes) * per_ray},
          {"leaves_per_ray", static_cast<double>(tests.leaves) * per_ray},
          {"crossings_per_ray", static_cast<double>(tests.crossings) * per_ray}};
}

}  // namespace

Statistics& Statistics::operator+=(const Statistics& other) {
  rays += other.rays;
  hits.resize(std::max(hits.size(), other.hits.size()));
  for (std::size_t leaf = 0; leaf < other.hits.size(); ++leaf) hits[leaf] += other.hits[leaf];
  nearest_tests += other.nearest_tests, shadow_tests += other.shadow_tests;
  return *this;
}

std::vector<std::size_t> leaves_hit(const Statistics& statistics) {
  std::vector<std::size_t> leaves;
  for (std::size_t leaf = 0; leaf < statistics.hits.size(); ++leaf)
    if (statistics.hits[leaf] > 0) leaves.push_back(leaf);
  std::ranges::stable_sort(leaves, std::greater{}, [&](std::size_t leaf) { return statistics.hits[leaf]; });
  return leaves;
}

nlohmann::json tests_json(const Statistics& s) {
  const RayCounters& rays = s.rays;
  return {{"nearest", to_json(s.nearest_tests, rays.primary + rays.reflected + rays.refracted)},
          {"shadow", to_json(s.shadow_tests, rays.shadow)}};
}

std::optional<Statistics> statistics_of_tile(const World& world, const RenderSettings& settings,
                                             std::uint32_t number, const std::function<bool()>& stop) {
  Tracer<WorkCounter> tracer(world, settings, WorkCounter(world));
  const Tile tile = tile_at({settings.width, settings.height}, number);
  std::uint64_t bad_samples = 0;
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y)
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
      const auto sum = pixel_sum(tracer, settings, {x, y}, stop);
      if (!sum) return std::nullopt;
      bad_samples += sum->bad_samples;
    }
  WorkCounter& counter = tracer.observer;
  Statistics result{counter.counters, std::move(counter.hits), counter.nearest.csg.tests,
                    counter.shadow.csg.tests};
  result.rays.bad_samples = bad_samples;
  return result;
}

std::optional<Statistics> statistics_of(
    const World& world, const RenderSettings& settings, unsigned threads, const std::function<bool()>& stop,
    const std::function<void(std::uint32_t done, std::uint32_t all)>& progress) {
  const Size film{settings.width, settings.height};
  std::mutex mutex;  // guards what follows
  Statistics total;
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
