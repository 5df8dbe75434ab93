// What encryption and the journal cost: the processor time of a master and two workers that render a picture, over TLS
// with a journal (rayfarm-master --state) and in plaintext without one (no --state), in turns. Each turn starts the
// programs anew, as where a process lies in memory is worth more than what is looked for.
//   rayfarm_bench_safety_cost [ROUNDS [WIDTH HEIGHT SPP]]      7 rounds of SphereFlake at 1920x1080, 16 samples a pixel
// Told are the medians of two ratios: of all processor time, which the PC's drift blurs by percents a round, and of what
// was used besides rendering (the busiest thread of a worker does only that, the same in both) to all of the plain
// farm's, which is exact. The exit code is 1 if the latter is above 3 %.
#include <cstdlib>
#include <fstream>

#include "tests/benchmark/real_farm.h"

namespace rayfarm {
namespace {

/// User and system time that a process or a thread has used.
double processor_seconds(const std::filesystem::path& folder) {
  std::ifstream stat(folder / "stat");
  std::string word;
  for (int i = 0; i < 13; ++i) stat >> word;  // the name has no space in it
  double user = 0, system = 0;
  stat >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

struct Cost {
  double rendering = 0, rest = 0;
  double sum() const { return rendering + rest; }
  void add(pid_t worker) {
    const std::filesystem::path process = "/proc/" + std::to_string(worker);
    double busiest = 0;
    for (const auto& thread : std::filesystem::directory_iterator(process / "task"))
      busiest = std::max(busiest, processor_seconds(thread.path()));
    rendering += busiest, rest += processor_seconds(process) - busiest;
  }
};

Cost cost_of(RealFarm::Kind kind, const JobSpec& spec) {
  const RealFarm farm(kind);
  std::vector<std::unique_ptr<ChildProgram>> workers;
  for (const char* name : {"pc1", "pc2"}) {
    if (kind == RealFarm::Kind::kept_and_encrypted) farm.join(name);
    workers.push_back(farm.worker(name, 1));
    farm.wait_for(name);
  }
  const auto used = [&] {
    Cost cost{.rest = processor_seconds("/proc/" + std::to_string(farm.pid()))};
    for (const auto& worker : workers) cost.add(worker->pid());
    return cost;
  };
  const Cost before = used();
  const std::uint64_t job = farm.submit(spec);
  while (farm.state_of(job) != "done") std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const Cost after = used();
  return {after.rendering - before.rendering, after.rest - before.rest};
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

bool compare(int rounds, const RenderSettings& settings) {
  const JobSpec spec = job_of_script("sphere_flake", settings);
  std::puts(
      "processor seconds   TLS, journal: rendering   rest    plain: rendering   rest    all, ratio   rest, "
      "%");
  std::vector<double> ratios, added;
  for (int i = 0; i < rounds; ++i) {
    const bool is_safe_first = i % 2 == 0;
    Cost safe, plain;
    if (is_safe_first) safe = cost_of(RealFarm::Kind::kept_and_encrypted, spec);
    plain = cost_of(RealFarm::Kind::plain, spec);
    if (!is_safe_first) safe = cost_of(RealFarm::Kind::kept_and_encrypted, spec);
    ratios.push_back(safe.sum() / plain.sum());
    added.push_back((safe.rest - plain.rest) / plain.sum());
    std::printf("round %-3d %34.2f %6.2f %19.2f %6.2f %13.3f %9.2f\n", i + 1, safe.rendering, safe.rest,
                plain.rendering, plain.rest, ratios.back(), 100 * added.back());
    std::fflush(stdout);
  }
  std::printf("medians: all %.4f of plain, added besides rendering %.2f %%\n", median(ratios),
              100 * median(added));
  return median(added) <= 0.03;
}

}  // namespace
}  // namespace rayfarm

int main(int argc, char** argv) {
  const auto number = [&](int place, int otherwise) {
    return argc > place ? std::atoi(argv[place]) : otherwise;
  };
  const rayfarm::RenderSettings settings{.width = static_cast<std::uint32_t>(number(2, 1920)),
                                         .height = static_cast<std::uint32_t>(number(3, 1080)),
                                         .spp = static_cast<std::uint32_t>(number(4, 16))};
  return rayfarm::compare(number(1, 7), settings) ? 0 : 1;
}
