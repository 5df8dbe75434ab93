// A farm to which by chance all happens that can: workers join, leave, come back with what they held, say nothing any
// more, lie, answer late and twice; jobs are paused, resumed, cancelled, reordered, some are verified, their frames come
// late; the farm ends and is built again from what it recorded.
#pragma once
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/master/farm/fake_worker.h"
#include "tests/master/farm/rebuilt_farm.h"

namespace rayfarm {

class Chaos {
 public:
  explicit Chaos(unsigned seed) : random_(seed) {}

  /// After every step the book kept by hand must agree with the rules.
  void run(int steps);
  /// Everything that is still wanted gets done, by workers who just work, though one that says nothing may hold some of
  /// it; how many jobs were done.
  std::size_t finish();

 private:
  struct Player {
    FakeWorker worker;
    WorkerInfo info;
    bool is_mute = false;  // says nothing any more, and is not lost
  };
  /// What a worker that was lost goes on with.
  struct Memory {
    WorkerInfo info;
    std::vector<HeldTile> held;
  };

  std::size_t chance(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  void step();

  // Workers.
  void join();
  void join_as(const WorkerInfo& info);
  void leave(std::size_t who);
  void stop(std::size_t who);
  void come_back();
  void say_what_is_held(const std::vector<HeldTile>& held);
  /// While its old connection is still there.
  void come_again(std::size_t who);
  void fall_silent();
  void drain_or_undrain();
  void ban_or_unban();
  void work();
  void answer_late();
  void break_the_rules();
  void give_back();
  void hand_in(std::size_t who, HeldAssignment work);
  void see_off_the_banned();
  std::size_t worker_with_work();
  void remember(const FakeWorker& worker);
  void keep_what_is_held(const Player& player);
  void forget(std::size_t who);

  // Jobs.
  void submit();
  void command_a_job();
  void remove(JobId job);
  void send_a_frame();
  void build_again();
  bool has_ended(JobId job) const;
  bool is_verified(JobId job) const;

  // What must be true.
  void check();
  void check_leases();
  void check_nobody_idles(const std::map<JobId, std::uint64_t>& pixels_leased);
  void check_events();
  void check_picture(const JobView& job);

  std::mt19937 random_;
  std::unique_ptr<Farm> farm_ = std::make_unique<Farm>();
  std::vector<FarmRecord> records_;  // of all its lives
  FarmTime now_{};
  std::vector<Player> players_;
  std::vector<Memory> memories_;
  std::map<JobId, Size> sizes_;
  std::map<JobId, std::vector<std::uint32_t>> to_come_;  // frames whose scenes have not come
  std::set<JobId> cancelled_, removed_;
  std::set<JobId> returned_to_;  // while they are paused, what was finished may be handed in
  std::set<std::pair<WorkerId, JobId>> refused_;
  std::vector<std::pair<WorkerId, HeldAssignment>> once_held_;
  std::uint64_t names_ = 0;
};

}  // namespace rayfarm
