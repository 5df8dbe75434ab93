// How soon a command frees a worker's thread in the middle of a slow tile, over real sockets. What else a farm reacts to
// is in reaction_benchmark.cpp.
#include <benchmark/benchmark.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <functional>

#include "master/script/script.h"
#include "tests/support/farm_jobs.h"
#include "tests/support/master_thread.h"
#include "tests/support/worker_thread.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

/// As many tiles as a worker of one thread holds; each would take an hour.
JobSpec slow_job() {
  static const SceneData scene =
      scene_data(evaluate_file(RAYFARM_SOURCE_DIR "/scenes/hedgehog_in_the_cage.lua", {}, 0).scene);
  JobSpec spec;
  spec.scene_hash = scene.hash;
  spec.scene_bytes = scene.bytes;
  spec.settings.width = 3 * tile_side, spec.settings.height = tile_side;
  spec.settings.spp = max_spp;
  return spec;
}

void measure(benchmark::State& state, Clock::time_point begin, Clock::time_point end) {
  state.SetIterationTime(std::chrono::duration<double>(end - begin).count());
}

/// When something happened first; told from another thread.
class Moment {
 public:
  void tell() {
    if (!told_.exchange(true)) promise_.set_value(Clock::now());
  }
  Clock::time_point wait() { return promise_.get_future().get(); }

 private:
  std::atomic<bool> told_{false};
  std::promise<Clock::time_point> promise_;
};

using Command = std::function<bool(Farm&, JobId, FarmTime)>;

void command_to_free_thread(benchmark::State& state, const Command& command) {
  spdlog::set_level(spdlog::level::off);
  for (auto _ : state) {
    Moment begun, freed;
    const PrepareScene prepare = [&](Scene scene) -> TileRenderer {
      return [&, render = prepare_scene(std::move(scene))](const auto&... what) {
        begun.tell();
        auto images = render(what...);
        freed.tell();
        return images;
      };
    };
    MasterThread master;
    WorkerThread worker(worker_for(master.address(), "pc"), prepare);
    master.wait_for_workers(1);
    const JobId job = master.ask([](Farm& farm, FarmTime now) { return farm.submit(slow_job(), now); });
    begun.wait();
    const auto begin = Clock::now();
    master.ask([&](Farm& farm, FarmTime now) { return command(farm, job, now); });
    measure(state, begin, freed.wait());
  }
}

double greatest(const std::vector<double>& times) { return std::ranges::max(times); }

void twenty_times(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseManualTime()->Iterations(1)->Repetitions(20)->ReportAggregatesOnly();
  benchmark->ComputeStatistics("max", greatest)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(command_to_free_thread, cancel, [](Farm& f, JobId job, FarmTime now) {
  return f.cancel(job, now);
})->Apply(twenty_times);
BENCHMARK_CAPTURE(command_to_free_thread, pause, [](Farm& f, JobId job, FarmTime now) {
  return f.pause(job, now);
})->Apply(twenty_times);
BENCHMARK_CAPTURE(command_to_free_thread, drain, [](Farm& f, JobId, FarmTime now) {
  return f.drain("pc", now);
})->Apply(twenty_times);

}  // namespace
}  // namespace rayfarm
