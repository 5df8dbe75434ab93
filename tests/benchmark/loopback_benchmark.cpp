// How many tiles a second go through a master and a worker over loopback, without rendering: assignment, frame,
// compression, checksum, encryption, socket, decompression, film; and what each costs of all threads' time.
#include <benchmark/benchmark.h>
#include <spdlog/spdlog.h>

#include <bit>
#include <random>
#include <thread>

#include "tests/support/farm_jobs.h"
#include "tests/support/farm_keys.h"
#include "tests/support/master_thread.h"
#include "tests/support/worker_thread.h"

namespace rayfarm {
namespace {

std::vector<PassImage> tile_of(const std::function<float()>& value) {
  std::vector<PassImage> images;
  for (int pass = 0; pass < pass_count; ++pass) {
    images.push_back({pass, std::vector<float>(3 * pixel_count({0, 0, tile_side, tile_side}, pass)), {}});
    for (float& v : images.back().rgb) v = value();
  }
  return images;
}

/// Colours as rendered ones are: exponents alike, mantissas noise.
std::vector<PassImage> noisy_tile() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> color(0.2f, 0.9f);
  return tile_of([&] { return color(random); });
}

enum class Wire { plaintext, tls };

void tiles_over_loopback(benchmark::State& state, const std::vector<PassImage>& images, Wire wire) {
  spdlog::set_level(spdlog::level::err);
  const RenderSettings settings{.width = 100 * tile_side, .height = 20 * tile_side, .spp = 1};
  const TileRenderer renderer = [&](const RenderSettings&, const Tile&, PassSet,
                                    const std::function<bool()>&) { return std::optional(images); };
  const FarmKeys keys;
  MasterThread master(patient_door(), {"127.0.0.1", 0}, wire == Wire::tls ? keys.of_master() : Security{});
  WorkerOptions options = worker_for(master.address(), "lab7");
  if (wire == Wire::tls) options.security = keys.of_worker("lab7");
  WorkerThread worker(options, [&](Scene) { return renderer; });
  master.wait_for_workers(1);
  for (auto _ : state) {
    const JobId job =
        master.ask([&](Farm& farm, FarmTime now) { return farm.submit(simple_job(settings), now); });
    while (master.ask([&](Farm& farm, FarmTime now) { return farm.job(job, now); })->state != JobState::done)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  state.SetItemsProcessed(state.iterations() * tile_count({settings.width, settings.height}));
}

void as_it_takes(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(tiles_over_loopback, black, tile_of([] { return 0.0f; }), Wire::plaintext)
    ->Apply(as_it_takes);
BENCHMARK_CAPTURE(tiles_over_loopback, black_tls, tile_of([] { return 0.0f; }), Wire::tls)
    ->Apply(as_it_takes);
BENCHMARK_CAPTURE(tiles_over_loopback, noise, noisy_tile(), Wire::plaintext)->Apply(as_it_takes);
BENCHMARK_CAPTURE(tiles_over_loopback, noise_tls, noisy_tile(), Wire::tls)->Apply(as_it_takes);

}  // namespace
}  // namespace rayfarm
