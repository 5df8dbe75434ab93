// A farm that goes on and on: small jobs, one after the other, by a worker that stays and three that come and go, some of
// them killed, all over TLS, with a journal. Each minute, when nobody but the one that stays is there, memory and open
// files of master and worker are printed.
//   rayfarm_soak [MINUTES]      10 unless told
// First as many jobs are rendered as the master keeps (1,000), so that what is kept no longer grows. From then on the exit
// code is 1 if the greatest memory of the last third is over that of the first by more than 3 % and 2 MB, or if there is an
// open file more.
#include <signal.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <random>
#include <thread>

#include "tests/benchmark/real_farm.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

struct Usage {
  double megabytes = 0;  // in memory
  std::size_t files = 0;
};

Usage usage_of(pid_t pid) {
  const std::filesystem::path process = "/proc/" + std::to_string(pid);
  double total = 0, pages = 0;
  std::ifstream(process / "statm") >> total >> pages;
  Usage usage{pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6, SIZE_MAX};
  // The fewest of some looks: for a moment, the journal's file is opened once more when its log is moved.
  for (int look = 0; look < 20; ++look) {
    const std::filesystem::directory_iterator files(process / "fd");
    usage.files = std::min(usage.files, static_cast<std::size_t>(std::distance(begin(files), end(files))));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return usage;
}

/// That the greatest of the last third is no greater than that of the first.
bool is_flat(const char* whose, const std::vector<Usage>& all) {
  const std::size_t third = std::max<std::size_t>(1, all.size() / 3);
  Usage first, last;
  for (std::size_t i = 0; i < third; ++i) {
    const Usage &early = all[i], &late = all[all.size() - 1 - i];
    first = {std::max(first.megabytes, early.megabytes), std::max(first.files, early.files)};
    last = {std::max(last.megabytes, late.megabytes), std::max(last.files, late.files)};
  }
  const bool is_good = last.megabytes <= 1.03 * first.megabytes + 2 && last.files <= first.files;
  std::printf("%s: %.1f -> %.1f MB, %zu -> %zu open files: %s\n", whose, first.megabytes, last.megabytes,
              first.files, last.files, is_good ? "flat" : "it grows");
  return is_good;
}

class Soak {
 public:
  Soak() {
    farm_.join("steady");
    for (const char* name : guests) farm_.join(name);
    steady_ = farm_.worker("steady", 1);
    farm_.wait_for("steady");
  }

  void fill_up() {
    for (int i = 0; i < jobs_kept; ++i) run_a_job();
    std::printf("%d jobs are there\n minute     jobs   master MB  files   worker MB  files\n", jobs_kept);
    note(0);
  }
  void run_for(std::chrono::minutes time) {
    for (int minute = 1; minute <= time.count(); ++minute) {
      for (const auto begin = Clock::now(); seconds_since(begin) < 60;) {
        come_or_go();
        run_a_job();
      }
      for (auto& guest : here_) guest.reset();
      farm_.wait_until([&] { return farm_.ask("/api/v1/workers").at("workers").size() == 1; });
      note(minute);
    }
  }
  bool is_flat() const {
    const bool is_master = rayfarm::is_flat("master", master_);
    return rayfarm::is_flat("worker", worker_) && is_master;
  }

 private:
  static constexpr int jobs_kept = 1000;
  static constexpr std::array guests{"guest0", "guest1", "guest2"};

  void run_a_job() {
    const std::uint64_t job = farm_.submit(spec_);
    farm_.wait_until([&] { return farm_.state_of(job) == "done"; });
    ++jobs_;
  }
  void come_or_go() {
    const std::size_t who = random_() % guests.size();
    if (!here_[who]) {
      here_[who] = farm_.worker(guests[who], 1);
    } else if (random_() % 2 == 0) {
      here_[who].reset();  // killed
    } else {
      here_[who]->send_signal(SIGTERM);
      here_[who]->result();
      here_[who].reset();
    }
  }
  void note(int minute) {
    master_.push_back(usage_of(farm_.pid()));
    worker_.push_back(usage_of(steady_->pid()));
    std::printf("%7d %8d %11.1f %6zu %11.1f %6zu\n", minute, jobs_, master_.back().megabytes,
                master_.back().files, worker_.back().megabytes, worker_.back().files);
    std::fflush(stdout);
  }

  RealFarm farm_{RealFarm::Kind::kept_and_encrypted};
  const JobSpec spec_ = job_of_script("sphere_flake", {.width = 128, .height = 96, .spp = 1});
  std::unique_ptr<ChildProgram> steady_;
  std::array<std::unique_ptr<ChildProgram>, guests.size()> here_;
  std::mt19937 random_{1};
  int jobs_ = 0;
  std::vector<Usage> master_, worker_;
};

}  // namespace
}  // namespace rayfarm

int main(int argc, char** argv) {
  const std::chrono::minutes time(argc > 1 ? std::atoi(argv[1]) : 10);
  rayfarm::Soak soak;
  soak.fill_up();
  soak.run_for(time);
  return soak.is_flat() ? 0 : 1;
}
