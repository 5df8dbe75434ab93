// How soon a farm reacts: our real programs over TLS on loopback, a master with a journal. Printed are median, p99 and
// worst of what the issue of the farm's safety asks for; the exit code is 1 when a p99 is over its limit.
//   rayfarm_bench_reaction
#include <signal.h>
#include <spdlog/spdlog.h>

#include <condition_variable>
#include <deque>
#include <mutex>

#include "tests/benchmark/real_farm.h"
#include "tests/support/worker_thread.h"
#include "worker/pairing.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

/// When a worker's threads got something to render; they are busy with it until they are stopped.
class Begins {
 public:
  PrepareScene prepare() {
    return [this](Scene) -> TileRenderer {
      return [this](const RenderSettings&, const Tile&, PassSet,
                    const std::function<bool()>& stop) -> std::optional<std::vector<PassImage>> {
        tell();
        while (!stop()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return std::nullopt;
      };
    };
  }
  Clock::time_point next() {
    std::unique_lock lock(mutex_);
    told_.wait(lock, [&] { return !moments_.empty(); });
    const Clock::time_point moment = moments_.front();
    moments_.pop_front();
    return moment;
  }

 private:
  void tell() {
    const std::lock_guard lock(mutex_);
    moments_.push_back(Clock::now());
    told_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable told_;
  std::deque<Clock::time_point> moments_;
};

/// False when the p99 is over the limit.
bool report(const char* what, std::vector<double> seconds, double limit) {
  std::ranges::sort(seconds);
  const std::size_t last = seconds.size() - 1;
  const double p99 = seconds[(last * 99 + 99) / 100];
  std::printf("%-58s %8.1f %8.1f %8.1f %8.0f %5zu\n", what, 1e3 * seconds[last / 2], 1e3 * p99,
              1e3 * seconds.back(), 1e3 * limit, seconds.size());
  std::fflush(stdout);
  return p99 < limit;
}

/// Tiles that would take hours; of a job that is verified, as nobody shares those.
JobSpec endless(std::uint32_t tiles) {
  JobSpec spec = job_of_script("hedgehog_in_the_cage",
                               {.width = tiles * tile_side, .height = tile_side, .spp = max_spp});
  spec.verification = Audit{0.01};
  return spec;
}

class Reactions {
 public:
  Reactions() {
    farm_.join("victim");
    const Pairing pairing = read_pairing(farm_.join("next")).value();
    WorkerOptions options;
    options.way = DialMaster{pairing.master};
    options.identity = {"next", "this PC", 2};
    options.security = {Exposure::closed, TlsContext(pairing.own, pairing.authority, PeerRole::master)};
    next_.emplace(std::move(options), begins_.prepare());
    farm_.wait_for("next");
  }

  bool submit_to_first_tile(int runs) {
    std::vector<double> times;
    for (int i = 0; i < runs; ++i) {
      const JobSpec spec = endless(1);
      const auto begin = Clock::now();
      const std::uint64_t job = farm_.submit(spec);
      times.push_back(std::chrono::duration<double>(begins_.next() - begin).count());
      cancel(job);
    }
    return report("a job is sent -> an idle worker's thread has its first tile", std::move(times), 0.1);
  }

  /// A worker that has begun a tile gets a signal; another one has a thread free.
  bool lost_to_given_again(const char* given_words, const char* lost_words, int signal, int runs,
                           double limit) {
    std::vector<double> given, lost;
    for (int i = 0; i < runs; ++i) {
      const auto victim = farm_.worker("victim", 1);
      farm_.wait_for("victim");
      const std::uint64_t job = farm_.submit(endless(2));
      begins_.next();
      farm_.wait_until([&] { return farm_.worker_view("victim").at("leases") == 1; });
      const auto begin = Clock::now();
      victim->send_signal(signal);
      given.push_back(std::chrono::duration<double>(begins_.next() - begin).count());
      farm_.wait_until([&] { return farm_.worker_view("victim").is_null(); });
      lost.push_back(seconds_since(begin));
      cancel(job);
    }
    const bool is_soon = report(given_words, std::move(given), limit);
    return report(lost_words, std::move(lost), limit + 0.5) && is_soon;
  }

 private:
  void cancel(std::uint64_t job) {
    farm_.post("/api/v1/jobs/" + std::to_string(job) + "/cancel", nlohmann::json::object());
    farm_.wait_until([&] { return farm_.worker_view("next").at("leases") == 0; });
  }

  RealFarm farm_{RealFarm::Kind::kept_and_encrypted};
  Begins begins_;
  std::optional<WorkerThread> next_;
};

}  // namespace
}  // namespace rayfarm

int main() {
  using namespace rayfarm;
  spdlog::set_level(spdlog::level::off);
  Reactions reactions;
  std::puts(
      "milliseconds                                                 median      p99    worst    limit  runs");
  bool is_good = reactions.submit_to_first_tile(50);
  is_good &=
      reactions.lost_to_given_again("a worker is killed -> another's thread has its tile",
                                    "                   -> it is gone from the list", SIGKILL, 50, 0.25);
  is_good &= reactions.lost_to_given_again("a worker is stopped -> another's thread has its tile, doubled",
                                           "                    -> it is given up", SIGSTOP, 20, 2);
  return is_good ? 0 : 1;
}
