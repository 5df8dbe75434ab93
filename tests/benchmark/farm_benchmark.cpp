// How many tiles a second the farm can give out and take in: no network, no rendering, black pixels.
//
// A tile counts its whole life in the farm: assignment, check of the result, 49 kB into the film, the next
// assignment.
#include <benchmark/benchmark.h>

#include <deque>
#include <memory>
#include <utility>

#include "master/farm.h"
#include "master/schedule.h"

namespace rayfarm {
namespace {

struct Delivery {
  WorkerId worker{};
  Assignment assignment;
};

std::vector<PassImage> black_tile() {
  std::vector<PassImage> images;
  for (int pass = 0; pass < pass_count; ++pass)
    images.push_back({pass, std::vector<float>(3 * pixel_count({0, 0, tile_side, tile_side}, pass)), {}});
  return images;
}

JobSpec job_of(Size film) {
  JobSpec spec;
  spec.scene_hash = "none";
  spec.scene_bytes = std::make_shared<const std::vector<std::uint8_t>>();
  spec.settings.width = film.width, spec.settings.height = film.height;
  return spec;
}

/// A job of 5,000 tiles through workers of 8 threads that answer in turn, a millisecond after each other.
void tiles_through_the_farm(benchmark::State& state) {
  const Size film{100 * tile_side, 50 * tile_side};
  const std::vector<PassImage> images = black_tile();
  for (auto _ : state) {
    state.PauseTiming();
    auto farm = std::make_unique<Farm>();
    std::deque<Delivery> under_way;
    for (std::int64_t i = 0; i < state.range(0); ++i) {
      const WorkerId id{static_cast<std::uint64_t>(i + 1)};  // as the farm numbers them
      const auto send = [&under_way, id](ToWorker message) {
        if (const auto* a = std::get_if<Assignment>(&message)) under_way.push_back({id, *a});
      };
      farm->add_worker({.name = "pc" + std::to_string(i), .threads = 8}, send, FarmTime{});
    }
    farm->submit(job_of(film), FarmTime{});
    state.ResumeTiming();

    for (FarmTime now{}; !under_way.empty(); now += std::chrono::milliseconds(1)) {
      const auto [worker, a] = under_way.front();
      under_way.pop_front();
      farm->receive(worker, Result{a.lease, a.job, a.frame, a.tile, images, 0.02}, now);
    }

    state.PauseTiming();
    if (farm->jobs(FarmTime{}).at(0).state != JobState::done) state.SkipWithError("the job is not done");
    farm.reset();
    state.ResumeTiming();
  }
  state.SetItemsProcessed(state.iterations() * tile_count(film));
}
BENCHMARK(tiles_through_the_farm)
    ->ArgName("workers")
    ->Arg(1)
    ->Arg(10)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);

/// Only the choice of tiles, for the largest film there is.
void tiles_through_the_schedule(benchmark::State& state) {
  const Size film{60'000, 8'333};
  for (auto _ : state) {
    state.PauseTiming();
    Schedule schedule(film);
    state.ResumeTiming();
    while (const auto work = schedule.take_tile()) schedule.finish(*work);
  }
  state.SetItemsProcessed(state.iterations() * tile_count(film));
}
BENCHMARK(tiles_through_the_schedule)->Unit(benchmark::kMillisecond);

/// A tenth of the tiles come back once and are given out again.
void tiles_given_back_to_the_schedule(benchmark::State& state) {
  const Size film{60'000, 8'333};
  for (auto _ : state) {
    state.PauseTiming();
    Schedule schedule(film);
    state.ResumeTiming();
    for (std::uint32_t n = 0; const auto work = schedule.take_tile(); ++n)
      n % 10 == 0 ? schedule.give_back(*work) : schedule.finish(*work);
  }
  state.SetItemsProcessed(state.iterations() * tile_count(film));
}
BENCHMARK(tiles_given_back_to_the_schedule)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rayfarm
