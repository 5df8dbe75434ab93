// How soon a click on a pixel is answered: through real HTTP, by a real master that renders on all its threads
// meanwhile. The scene has been made ready by a first click. Wanted: 50 ms at the 99th percentile.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <random>
#include <stdexcept>

#include "master/http/client.h"
#include "tests/support/child_program.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint32_t width = 1920, height = 1080;

/// A master busy for hours.
class BusyMaster {
 public:
  explicit BusyMaster(const std::vector<std::string>& parameters)
      : master_({"rayfarm-master", "--listen", "127.0.0.1:0", "--http", "127.0.0.1:0"}, {}, "/dev/null") {
    const std::string line = master_.next_line();
    url_ = line.substr(line.find("http ") + 5);
    std::vector<std::string> words{"rayfarm",   "submit", RAYFARM_SOURCE_DIR "/scenes/sphere_flake.lua",
                                   "-o",        "x.exr",  "--size",
                                   "1920x1080", "--spp",  "65536"};
    words.insert(words.end(), parameters.begin(), parameters.end());
    const ProgramResult submitted = run_program(words, {{"RAYFARM_MASTER", url_}});
    if (submitted.exit_code != 0) throw std::runtime_error(submitted.err);
    trace(width / 2, height / 2, "0");
  }
  void trace(std::uint32_t x, std::uint32_t y, const std::string& sample) const {
    const std::string target =
        "/api/v1/jobs/1/trace?x=" + std::to_string(x) + "&y=" + std::to_string(y) + "&sample=" + sample;
    const HttpReply reply = send({.url = url_, .target = target, .body = {}});
    if (reply.status != 200) throw std::runtime_error(reply.body);
  }

 private:
  ChildProgram master_;
  std::string url_;
};

void click(benchmark::State& state, const std::vector<std::string>& parameters, const std::string& sample) {
  static std::vector<std::string> rendered;
  static std::unique_ptr<BusyMaster> master;
  static std::mt19937 random;
  if (!master || rendered != parameters) {
    master = std::make_unique<BusyMaster>(parameters);
    rendered = parameters;
  }
  const auto up_to = [&](std::uint32_t end) {
    return std::uniform_int_distribution<std::uint32_t>(0, end - 1)(random);
  };
  for (auto _ : state) {
    const auto begin = Clock::now();
    master->trace(up_to(width), up_to(height), sample);
    state.SetIterationTime(std::chrono::duration<double>(Clock::now() - begin).count());
  }
}

double percentile_99(const std::vector<double>& times) {
  std::vector<double> sorted = times;
  std::ranges::sort(sorted);
  return sorted[sorted.size() * 99 / 100];
}
double greatest(const std::vector<double>& times) { return std::ranges::max(times); }

void two_hundred_times(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseManualTime()->Iterations(1)->Repetitions(200)->ReportAggregatesOnly();
  benchmark->ComputeStatistics("p99", percentile_99)->ComputeStatistics("max", greatest);
  benchmark->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(click, diffuse_one_sample, {}, "0")->Apply(two_hundred_times);
BENCHMARK_CAPTURE(click, glass_one_sample, {"-p", "mat=glass"}, "0")->Apply(two_hundred_times);

}  // namespace
}  // namespace rayfarm
