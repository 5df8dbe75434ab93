// The farm under chance: workers join, leave, lie, answer late and twice; jobs are paused, resumed,
// cancelled, reordered, their frames come late; the farm ends and is built again from what it recorded. After every step the book kept by hand must agree with the rules; in the end with the
// pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <tuple>

#include "master/split.h"
#include "tests/master/farm/fake_worker.h"
#include "tests/master/farm/rebuilt_farm.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

class Chaos {
 public:
  explicit Chaos(unsigned seed) : random_(seed) {}

  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      now_ += std::chrono::milliseconds(chance(40));
      farm_->tick(now_);
      step();
      check_leases();
      if (testing::Test::HasFatalFailure()) return;
    }
  }

  /// Everything that is still wanted gets done, by one new worker who just works.
  void finish() {
    for (const auto& [id, size] : sizes_) farm_->resume(id, now_);
    while (!to_come_.empty()) send_a_frame();
    while (!workers_.empty()) stop(0);
    FakeWorker last(*farm_, {.name = "last", .threads = 4, .takes_pieces = chance(2) == 0}, now_);
    last.finish_all(now_);
    for (const auto& [id, size] : sizes_) {
      ASSERT_EQ(farm_->was_here(id), removed_.contains(id));
      if (removed_.contains(id)) continue;
      const JobView job = farm_->job(id, now_).value();
      if (cancelled_.contains(id)) {
        EXPECT_EQ(job.state, JobState::cancelled);
        continue;
      }
      if (job.state == JobState::failed) continue;  // over it too many workers were lost
      ASSERT_EQ(job.state, JobState::done);
      RayCounters sum;
      for (const FrameView& frame : farm_->frames(id, now_)) {
        EXPECT_EQ(farm_->film(id, frame.frame)->rgb(), made_up_picture(id, size, frame.frame));
        EXPECT_EQ(frame.counters, made_up_counters(size)) << "a pass was committed twice, or not at all";
        sum += frame.counters;
      }
      EXPECT_EQ(job.counters, sum);
    }
  }

 private:
  std::size_t chance(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  void step() {
    if (chance(100) == 0) return build_again();
    switch (chance(24)) {
      case 0:
        return join();
      case 1:
        return workers_.size() > 1 ? leave(chance(workers_.size())) : join();
      case 2:
        return submit();
      case 3:
        return command_a_job();
      case 4:
        return drain_or_undrain();
      case 5:
        return answer_late();
      case 6:
        return lie();
      case 7:
        return give_back();
      case 8:
      case 9:
        return send_a_frame();
      case 10:
        return workers_.size() > 1 ? stop(chance(workers_.size())) : join();
      default:
        return work();
    }
  }

  void join() {
    if (workers_.size() >= 8) return;
    const auto kind = chance(3) == 0 ? WorkerKind::local : WorkerKind::remote;
    const auto threads = static_cast<std::uint32_t>(1 + chance(4));
    const std::string name =
        "pc" + std::to_string(names_++);  // who lied twice does not come again by the same
    workers_.emplace_back(
        *farm_, WorkerInfo{.name = name, .threads = threads, .kind = kind, .takes_pieces = chance(3) != 0},
        now_);
  }

  void leave(std::size_t who) {
    remember(workers_[who]);
    farm_->remove_worker(workers_[who].id(), "gone", now_);
    workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(who));
  }

  void stop(std::size_t who) {
    remember(workers_[who]);
    farm_->receive(workers_[who].id(), GiveBack{}, now_);
    leave(who);
  }

  void build_again() {
    std::ranges::move(farm_->take_records(), std::back_inserter(records_));
    expect_same(*farm_, Farm({}, past_of(records_), now_), now_);
    farm_ = std::make_unique<Farm>(FarmLimits{}, past_of(records_), now_);
    workers_.clear(), once_held_.clear(), refused_.clear();
    join();
  }

  void send_a_frame() {
    if (to_come_.empty()) return;
    const auto next = std::next(to_come_.begin(), static_cast<std::ptrdiff_t>(chance(to_come_.size())));
    const auto [job, frames] = *next;
    const bool goes_on = add_frame(*farm_, job, frames.front(), now_);
    ASSERT_EQ(goes_on, !has_ended(job));
    next->second.erase(next->second.begin());
    if (!goes_on || next->second.empty()) to_come_.erase(next);
  }

  bool has_ended(JobId job) {
    if (removed_.contains(job)) return true;
    const JobState state = farm_->job(job, now_)->state;
    return state == JobState::cancelled || state == JobState::failed;
  }

  void submit() {
    if (sizes_.size() >= 12) return;
    const Size size{static_cast<std::uint32_t>(1 + chance(400)), static_cast<std::uint32_t>(1 + chance(200))};
    JobSpec spec = job_of(size, "job", "scene " + std::to_string(chance(3)));
    spec.priority = static_cast<int>(chance(5));
    spec.hold = chance(5) == 0;
    const auto frames = static_cast<std::uint32_t>(1 + chance(4)),
               step = static_cast<std::uint32_t>(1 + chance(3));
    spec.frames = FrameRange{0, (frames - 1) * step, step};
    const JobId id = farm_->submit(spec, now_);
    sizes_[id] = size;
    for (std::uint32_t i = 1; i < frames; ++i) to_come_[id].push_back(spec.frames->at(i));
  }

  void command_a_job() {
    if (sizes_.empty()) return;
    const JobId job = std::next(sizes_.begin(), static_cast<std::ptrdiff_t>(chance(sizes_.size())))->first;
    for (const FakeWorker& worker : workers_) remember(worker);
    if (chance(20) == 0) return remove(job);
    switch (chance(8)) {
      case 0:
        if (farm_->cancel(job, now_)) cancelled_.insert(job);
        return;
      case 1:
      case 2:
        farm_->pause(job, now_);
        return;
      case 3:
      case 4:
      case 5:
        farm_->resume(job, now_);
        return;
      default:
        farm_->set_priority(job, static_cast<int>(chance(5)), now_);
        return;
    }
  }

  void remove(JobId job) {
    const std::optional<JobView> view = farm_->job(job, now_);
    const bool may_go = view && (view->state == JobState::done || has_ended(job));
    ASSERT_EQ(farm_->remove(job), may_go);
    if (may_go) removed_.insert(job);
  }

  void drain_or_undrain() {
    if (workers_.empty()) return;
    const FakeWorker& worker = workers_[chance(workers_.size())];
    remember(worker);
    if (chance(3) == 0)
      farm_->drain(worker.name(), now_);
    else
      farm_->undrain(worker.name(), now_);
  }

  /// A result for a lease that was once somebody's: revoked, already answered, or still held by another.
  void answer_late() {
    if (workers_.empty() || once_held_.empty()) return;
    const auto& [holder, old] = once_held_[chance(once_held_.size())];
    const auto its = std::ranges::find(workers_, holder, &FakeWorker::id);
    if (its == workers_.end() && chance(8) != 0) return;
    const std::size_t who =
        its == workers_.end() ? chance(workers_.size()) : static_cast<std::size_t>(its - workers_.begin());
    if (std::ranges::count(workers_[who].held(), old.lease, &Assignment::lease) != 0) return;
    try {
      if (old.piece)
        farm_->receive(workers_[who].id(), rendered_piece(old), now_);
      else
        farm_->receive(workers_[who].id(), rendered(old, sizes_.at(old.job)), now_);
    } catch (const WorkerError&) {
      leave(who);
    }
  }

  void lie() {
    const std::size_t who = worker_with_work();
    if (who == workers_.size()) return;
    const HeldAssignment held = workers_[who].held()[0];
    Result result = held.piece ? rendered_piece(held).result : rendered(held, sizes_.at(held.job));
    switch (chance(3)) {
      case 0:
        result.tile += 1;
        break;
      case 1:
        result.images.pop_back();
        break;
      default:
        result.images[0].rgb.pop_back();
        break;
    }
    if (held.piece)
      EXPECT_THROW(farm_->receive(workers_[who].id(), PieceResult{result, *held.piece}, now_), WorkerError);
    else
      EXPECT_THROW(farm_->receive(workers_[who].id(), result, now_), WorkerError);
    workers_[who].drop(result.lease);
    leave(who);
  }

  void give_back() {
    const std::size_t who = worker_with_work();
    if (who == workers_.size()) return;
    FakeWorker& worker = workers_[who];
    const Assignment given = worker.held()[chance(worker.held().size())];
    const bool is_refusal = chance(2) == 0;
    // A job that everybody refuses fails, by right; here somebody always can.
    if (is_refusal && farm_->job(given.job, now_)->pixels_done == 0) return;
    remember(worker);
    worker.drop(given.lease);
    if (is_refusal) refused_.insert({worker.id(), given.job});
    farm_->receive(worker.id(), GiveBack{{given.lease}, is_refusal ? "out of memory" : ""}, now_);
    if (!is_refusal) leave(who);
  }

  void work() {
    const std::size_t who = worker_with_work();
    if (who == workers_.size()) return;
    once_held_.emplace_back(workers_[who].id(), workers_[who].held()[0]);
    workers_[who].finish_one(now_, 0.001 * static_cast<double>(chance(30)));
  }

  std::size_t worker_with_work() {
    std::vector<std::size_t> busy;
    for (std::size_t i = 0; i < workers_.size(); ++i)
      if (!workers_[i].held().empty()) busy.push_back(i);
    return busy.empty() ? workers_.size() : busy[chance(busy.size())];
  }

  void remember(const FakeWorker& worker) {
    for (const HeldAssignment& work : worker.held()) once_held_.emplace_back(worker.id(), work);
  }

  /// What the workers were told they hold is what the farm says they hold; no pass, or piece of one, is leased to more than
  /// two or leased when it is done; nobody who may work is idle while something waits.
  void check_leases() {
    std::map<std::tuple<JobId, std::uint32_t, std::uint32_t, int>,
             std::map<std::pair<std::uint32_t, std::uint32_t>, int>>
        leased;
    std::map<JobId, std::uint64_t> pixels_leased;
    const std::vector<WorkerView> views = farm_->workers();
    ASSERT_EQ(views.size(), workers_.size());
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      ASSERT_EQ(views[i].id, workers_[i].id());
      ASSERT_EQ(views[i].leases, workers_[i].held().size());
      if (views[i].state == WorkerState::drained) {
        ASSERT_EQ(views[i].leases, 0u);
      }
      for (const HeldAssignment& a : workers_[i].held())
        for (int pass = 0; pass < pass_count; ++pass) {
          if (!(a.passes & 1u << pass)) continue;
          auto& squares = leased[{a.job, a.frame, a.tile, pass}];
          const bool is_first = squares.empty();
          for (const Tile& square : pieces_of(a.piece.value_or(tile_at(sizes_.at(a.job), a.tile)), 16))
            ASSERT_LE((++squares[{square.x0, square.y0}]), 2) << "leased three times";
          ASSERT_FALSE(farm_->film(a.job, a.frame)->passes_of(a.tile) & 1u << pass) << "leased though done";
          if (is_first) pixels_leased[a.job] += pixel_count(tile_at(sizes_.at(a.job), a.tile), pass);
        }
    }
    for (const JobView& job : farm_->jobs(now_)) {
      const bool is_open = job.state == JobState::running || job.state == JobState::waiting;
      ASSERT_TRUE(pixels_leased[job.id] == 0 || is_open) << "leased though not running";
      const std::uint64_t pixels_sent = job.pixels_total / job.frames.count() * job.frames_sent;
      if (!is_open || job.pixels_done + pixels_leased[job.id] == pixels_sent) continue;
      for (const WorkerView& worker : views) {
        const bool may_work = worker.state != WorkerState::drained && !refused_.contains({worker.id, job.id});
        ASSERT_TRUE(worker.leases > 0 || !may_work) << "idle though something waits";
      }
    }
    for (const FarmEvent& event : farm_->take_events())
      ASSERT_EQ(event.text.find("differ"), std::string::npos) << event.text;
  }

  std::mt19937 random_;
  std::unique_ptr<Farm> farm_ = std::make_unique<Farm>();
  std::vector<FarmRecord> records_;  // of all its lives
  FarmTime now_{};
  std::vector<FakeWorker> workers_;
  std::map<JobId, Size> sizes_;
  std::map<JobId, std::vector<std::uint32_t>> to_come_;  // frames whose scenes have not come
  std::set<JobId> cancelled_, removed_;
  std::set<std::pair<WorkerId, JobId>> refused_;
  std::vector<std::pair<WorkerId, HeldAssignment>> once_held_;
  int names_ = 0;
};

TEST(Farm, CommitsEachPassOfEachTileExactlyOnceWhateverHappens) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Chaos chaos(seed);
    chaos.run(1500);
    chaos.finish();
    if (testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace rayfarm
