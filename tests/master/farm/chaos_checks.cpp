// What must be true of a farm whatever happens to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "master/split.h"
#include "tests/master/farm/chaos.h"

namespace rayfarm {

using namespace std::chrono_literals;

void Chaos::check() {
  check_leases();
  check_events();
}

/// What the workers were told they hold is what the farm says they hold; no pass, or piece of one, is leased to more than
/// two or leased when it is done; nobody who may work is idle while something waits. On verified work any number may be
/// asked.
void Chaos::check_leases() {
  std::map<std::tuple<JobId, std::uint32_t, std::uint32_t, int>,
           std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<WorkerId>>>
      leased;
  std::map<JobId, std::uint64_t> pixels_leased;
  const std::vector<WorkerView> views = farm_->workers();
  ASSERT_EQ(views.size(), players_.size());
  for (std::size_t i = 0; i < players_.size(); ++i) {
    const FakeWorker& worker = players_[i].worker;
    ASSERT_EQ(views[i].id, worker.id());
    ASSERT_EQ(views[i].leases, worker.held().size());
    if (views[i].state == WorkerState::drained) {
      ASSERT_EQ(views[i].leases, 0u);
    }
    for (const HeldAssignment& a : worker.held())
      for (int pass = 0; pass < pass_count; ++pass) {
        if (!(a.passes & 1u << pass)) continue;
        auto& squares = leased[{a.job, a.frame, a.tile, pass}];
        const bool is_first = squares.empty();
        for (const Tile& square : pieces_of(a.piece.value_or(tile_at(sizes_.at(a.job), a.tile)), 16)) {
          std::set<WorkerId>& holders = squares[{square.x0, square.y0}];
          holders.insert(worker.id());
          ASSERT_TRUE(holders.size() <= 2 || is_verified(a.job)) << "leased to three";
        }
        ASSERT_FALSE(a.piece && is_verified(a.job)) << "a piece of verified work";
        ASSERT_FALSE(farm_->film(a.job, a.frame)->passes_of(a.tile) & 1u << pass) << "leased though done";
        if (is_first) pixels_leased[a.job] += pixel_count(tile_at(sizes_.at(a.job), a.tile), pass);
      }
  }
  check_nobody_idles(pixels_leased);
}

void Chaos::check_nobody_idles(const std::map<JobId, std::uint64_t>& pixels_leased) {
  const std::vector<WorkerView> views = farm_->workers();
  for (const JobView& job : farm_->jobs(now_)) {
    const bool is_open = job.state == JobState::running || job.state == JobState::waiting;
    const auto leased = pixels_leased.find(job.id);
    const std::uint64_t pixels = leased == pixels_leased.end() ? 0 : leased->second;
    const bool may_be_handed_in = job.state == JobState::paused && returned_to_.contains(job.id);
    ASSERT_TRUE(pixels == 0 || is_open || may_be_handed_in) << "leased though not running";
    const std::uint64_t pixels_sent = job.pixels_total / job.frames.count() * job.frames_sent;
    if (!is_open || is_verified(job.id) || job.pixels_done + pixels == pixels_sent) continue;
    for (const WorkerView& worker : views) {
      const bool may_work = worker.state != WorkerState::drained && !refused_.contains({worker.id, job.id});
      ASSERT_TRUE(worker.leases > 0 || !may_work) << "idle though something waits";
    }
  }
}

/// Nobody is accused who did not lie.
void Chaos::check_events() {
  for (const FarmEvent& event : farm_->take_events()) {
    ASSERT_EQ(event.text.find("differ"), std::string::npos) << event.text;
    if (event.text.find("delivered wrong pixels") != std::string::npos) {
      ASSERT_TRUE(event.worker.starts_with("liar")) << event.text;
    }
  }
}

void Chaos::check_picture(const JobView& job) {
  const Size size = sizes_.at(job.id);
  RayCounters sum;
  FarmTime taken{};
  for (const FrameView& frame : farm_->frames(job.id, now_)) {
    EXPECT_EQ(farm_->film(job.id, frame.frame)->rgb(), made_up_picture(job.id, size, frame.frame));
    EXPECT_EQ(frame.counters, made_up_counters(size)) << "a pass was committed twice, or not at all";
    sum += frame.counters;
    taken += frame.thread_time;
  }
  EXPECT_EQ(job.counters, sum);
  EXPECT_EQ(job.thread_time, taken);
}

std::size_t Chaos::finish() {
  for (const auto& [id, size] : sizes_) farm_->resume(id, now_);
  while (!to_come_.empty()) send_a_frame();
  const auto mute = std::ranges::find_if(players_, &Player::is_mute);
  const std::size_t stays = mute == players_.end() ? 0 : 1;
  if (stays == 1) std::iter_swap(mute, players_.begin());
  while (players_.size() > stays) stop(players_.size() - 1);
  std::vector<FakeWorker> last;
  for (const char* name : {"last 1", "last 2", "last 3"})
    last.emplace_back(*farm_, WorkerInfo{.name = name, .threads = 4, .takes_pieces = chance(2) == 0}, now_);
  const auto is_at_work = [&](const JobView& job) {
    return job.state == JobState::running || job.state == JobState::waiting;
  };
  const FarmTime patience = now_ + 1h;
  while (std::ranges::any_of(farm_->jobs(now_), is_at_work) && now_ < patience) {
    for (FakeWorker& worker : last) worker.finish_all(now_);
    farm_->tick(now_ += 100ms);
  }
  std::size_t done = 0;
  for (const auto& [id, size] : sizes_) {
    EXPECT_EQ(farm_->was_here(id), removed_.contains(id));
    if (removed_.contains(id)) continue;
    const JobView job = farm_->job(id, now_).value();
    if (cancelled_.contains(id)) {
      EXPECT_EQ(job.state, JobState::cancelled);
    }
    if (has_ended(id)) continue;  // of those that failed, over some too many workers were lost
    EXPECT_EQ(job.state, JobState::done) << "it waits for ever";
    if (job.state != JobState::done) continue;
    check_picture(job);
    ++done;
  }
  return done;
}

}  // namespace rayfarm
