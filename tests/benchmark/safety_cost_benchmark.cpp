// What encryption and the journal cost: the processor time of a master and a worker that render a picture, over TLS with a
// journal (rayfarm-master --state) and in plaintext without one (no --state), in turns.
//   rayfarm_bench_safety_cost [ROUNDS [WIDTH HEIGHT SPP]]      3 rounds of SphereFlake at 1920x1080, 16 samples a pixel
// The exit code is 1 if the median with both is more than 3 % over that without.
#include <cstdlib>
#include <fstream>

#include "tests/benchmark/real_farm.h"

namespace rayfarm {
namespace {

/// User and system time that a process has used.
double processor_seconds(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string word;
  for (int i = 0; i < 13; ++i) stat >> word;  // the name has no space in it
  double user = 0, system = 0;
  stat >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

struct Cost {
  double master = 0, worker = 0;
  double sum() const { return master + worker; }
};

class Side {
 public:
  explicit Side(RealFarm::Kind kind) : farm_(kind) {
    if (kind == RealFarm::Kind::kept_and_encrypted) farm_.join("pc");
    worker_ = farm_.worker("pc", 1);
    farm_.wait_for("pc");
  }
  Cost cost_of(const JobSpec& spec) const {
    const Cost before = used();
    const std::uint64_t job = farm_.submit(spec);
    while (farm_.state_of(job) != "done") std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const Cost after = used();
    return {after.master - before.master, after.worker - before.worker};
  }

 private:
  Cost used() const { return {processor_seconds(farm_.pid()), processor_seconds(worker_->pid())}; }

  RealFarm farm_;
  std::unique_ptr<ChildProgram> worker_;
};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

bool compare(int rounds, const RenderSettings& settings) {
  const JobSpec spec = job_of_script("sphere_flake", settings);
  const Side safe(RealFarm::Kind::kept_and_encrypted), plain(RealFarm::Kind::plain);
  std::puts("processor seconds      TLS, journal: master   worker      plain: master   worker    ratio");
  std::vector<double> ratios;
  for (int i = 0; i < rounds; ++i) {
    const bool is_safe_first = i % 2 == 0;
    Cost a, b;
    if (is_safe_first) a = safe.cost_of(spec);
    b = plain.cost_of(spec);
    if (!is_safe_first) a = safe.cost_of(spec);
    ratios.push_back(a.sum() / b.sum());
    std::printf("round %-3d %35.2f %8.2f %19.2f %8.2f %8.3f\n", i + 1, a.master, a.worker, b.master, b.worker,
                ratios.back());
    std::fflush(stdout);
  }
  const double ratio = median(ratios);  // of rounds: a PC's speed drifts by more than what is looked for
  std::printf("median of the ratios %.4f\n", ratio);
  return ratio <= 1.03;
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
  return rayfarm::compare(number(1, 3), settings) ? 0 : 1;
}
