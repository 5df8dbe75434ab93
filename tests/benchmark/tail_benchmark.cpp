// How long threads idle at the end of a picture: a farm of real workers on loopback, one of them ten times slower, whose
// renderers wait as long as a tile would take, so that the figures do not depend on this PC's cores. Printed are the
// thread time that is idle from the moment on when no tile waits any more, and the thread time that is spent in vain, both
// as shares of wall time x threads; medians and the worst of a few runs.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <random>

#include "tests/support/farm_jobs.h"
#include "tests/support/master_thread.h"
#include "tests/support/worker_thread.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

struct Case {
  Size film;
  int workers;
  std::uint32_t threads;
  double seconds_a_tile;
  double slowness = 10;  // of the last worker
  double heaviest = 0;   // share of the picture that one tile takes; 0: none is out of the common
};

/// Seconds of a fast thread: much in the middle of the picture, little at its edges, and never quite as its neighbours.
std::vector<double> tile_costs(const Case& c) {
  const Size film = c.film;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(0.6, 1.6);
  std::vector<double> costs;
  double sum = 0;
  for (std::uint32_t tile = 0; tile < tile_count(film); ++tile) {
    const Tile t = tile_at(film, tile);
    const double u = (t.x0 + t.x1 - 1.0 * film.width) / film.width;
    const double v = (t.y0 + t.y1 - 1.0 * film.height) / film.height;
    costs.push_back((0.1 + std::exp(-3 * (u * u + v * v))) * noise(random));
    sum += costs.back();
  }
  const double all = c.seconds_a_tile * static_cast<double>(costs.size());
  for (double& cost : costs) cost *= (1 - c.heaviest) * all / sum;
  if (c.heaviest > 0) costs[costs.size() / 3] = c.heaviest * all;
  return costs;
}

/// When the threads of all workers rendered.
class Timesheet {
 public:
  void add(Clock::time_point begin, Clock::time_point end) {
    const std::lock_guard lock(mutex_);
    busy_.emplace_back(begin, end);
  }
  Seconds busy_between(Clock::time_point from, Clock::time_point to) const {
    const std::lock_guard lock(mutex_);
    Seconds sum{};
    for (const auto& [begin, end] : busy_) {
      const auto first = std::max(begin, from), last = std::min(end, to);
      if (first < last) sum += last - first;
    }
    return sum;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::pair<Clock::time_point, Clock::time_point>> busy_;
};

PrepareScene waiting_renderer(const std::vector<double>& costs, double slowness, Timesheet& sheet) {
  return [&costs, &sheet, slowness](Scene) -> TileRenderer {
    return [&costs, &sheet, slowness](const RenderSettings& settings, const Tile& area, PassSet passes,
                                      const auto& stop) -> std::optional<std::vector<PassImage>> {
      const double cost = costs[(area.y0 / tile_side) * (settings.width / tile_side) + area.x0 / tile_side];
      auto images = position_area(settings, area, passes, [] { return false; });
      std::uint64_t pixels = 0;
      for (const PassImage& image : *images) pixels += image.rgb.size() / 3;
      const double share = static_cast<double>(pixels) / (tile_side * tile_side);
      for (PassImage& image : *images)
        image.counters.primary =
            static_cast<std::uint64_t>(1e6 * cost * static_cast<double>(image.rgb.size()) / 3 / 4096);
      const auto begin = Clock::now();
      const auto end = begin + std::chrono::duration_cast<Clock::duration>(Seconds(cost * slowness * share));
      while (Clock::now() < end && !stop())
        std::this_thread::sleep_for(
            std::min<Clock::duration>(end - Clock::now(), std::chrono::milliseconds(1)));
      sheet.add(begin, Clock::now());
      if (stop()) return std::nullopt;
      return images;
    };
  };
}

struct Figures {
  double wall = 0, idle = 0, wasted = 0;  // seconds, and shares
  std::uint64_t doubled = 0, shared = 0;
};

/// Waits until no tile waits: all are done or leased.
void wait_for_tail(MasterThread& master, JobId job, Size film) {
  const std::uint64_t tiles = tile_count(film);
  master.wait_until([&](Farm& farm) {
    const std::uint64_t done = farm.job(job, {})->pixels_done / (tile_side * tile_side);
    std::uint64_t leased = 0;
    for (const WorkerView& worker : farm.workers()) leased += worker.leases;
    return done + leased >= tiles;
  });
}

Figures run(const Case& c) {
  const std::vector<double> costs = tile_costs(c);
  Timesheet sheet;
  MasterThread master;
  std::vector<std::unique_ptr<WorkerThread>> workers;
  for (int i = 0; i < c.workers; ++i) {
    WorkerOptions options = worker_for(master.address(), "pc");
    options.identity.threads = c.threads;
    const double slowness = i + 1 == c.workers ? c.slowness : 1;
    workers.push_back(std::make_unique<WorkerThread>(options, waiting_renderer(costs, slowness, sheet)));
  }
  master.wait_for_workers(static_cast<std::size_t>(c.workers));
  const RenderSettings settings{.width = c.film.width, .height = c.film.height, .spp = 1};
  const auto begin = Clock::now();
  const JobId job = master.ask([&](Farm& f, FarmTime now) { return f.submit(simple_job(settings), now); });
  wait_for_tail(master, job, c.film);
  const auto queue_empty = Clock::now();
  master.wait_until([&](Farm& farm) { return farm.job(job, {})->state == JobState::done; });
  const auto end = Clock::now();
  const JobView view = *master.ask([&](Farm& f, FarmTime now) { return f.job(job, now); });
  const double threads = c.workers * static_cast<double>(c.threads);
  const double wall = Seconds(end - begin).count();
  const double tail = Seconds(end - queue_empty).count();
  const double busy = sheet.busy_between(queue_empty, end).count();
  return {wall, (tail * threads - busy) / (wall * threads),
          Seconds(view.time_wasted).count() / (wall * threads), view.tiles_doubled, view.tiles_shared};
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

void print(const Case& c) {
  constexpr int runs = 5;
  std::vector<double> walls, idle, wasted, doubled, shared;
  for (int i = 0; i < runs; ++i) {
    const Figures figures = run(c);
    walls.push_back(figures.wall), idle.push_back(100 * figures.idle), wasted.push_back(100 * figures.wasted);
    doubled.push_back(static_cast<double>(figures.doubled));
    shared.push_back(static_cast<double>(figures.shared));
  }
  std::printf("%5ux%-5u %3d x %-3u %8.0f %9.0f %8.2f %9.2f %9.2f %9.2f %8.0f %7.0f\n", c.film.width,
              c.film.height, c.workers, c.threads, c.slowness, 100 * c.heaviest, median(walls), median(idle),
              std::ranges::max(idle), median(wasted), median(doubled), median(shared));
  std::fflush(stdout);
}

}  // namespace
}  // namespace rayfarm

int main() {
  using namespace rayfarm;
  spdlog::set_level(spdlog::level::err);
  std::puts(
      "  picture    workers  slowness  heavy, %  wall, s   idle, %     worst  wasted, %  doubled  shared");
  print({{640, 512}, 3, 1, 0.04});
  print({{640, 512}, 4, 2, 0.1});
  print({{1280, 768}, 4, 4, 0.1});
  print({{1920, 1088}, 10, 4, 0.1});
  print({{128, 128}, 4, 2, 0.5, 1});
  print({{320, 256}, 4, 2, 0.1, 1, 1.0 / 3});
  print({{640, 512}, 4, 2, 0.05, 1, 1.0 / 3});
}
