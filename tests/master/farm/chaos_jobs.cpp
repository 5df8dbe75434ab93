// What people do, and the end of the master.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "tests/master/farm/chaos.h"

namespace rayfarm {

void Chaos::submit() {
  if (sizes_.size() >= 12) return;
  const Size size{static_cast<std::uint32_t>(1 + chance(400)), static_cast<std::uint32_t>(1 + chance(200))};
  JobSpec spec = job_of(size, "job", "scene " + std::to_string(chance(3)));
  spec.priority = static_cast<int>(chance(5));
  spec.hold = chance(5) == 0;
  const std::size_t verification = chance(6);
  if (verification == 0) spec.verification = Quorum{2};
  if (verification == 1) spec.verification = Audit{1};
  const auto frames = static_cast<std::uint32_t>(1 + chance(4)),
             step = static_cast<std::uint32_t>(1 + chance(3));
  spec.frames = FrameRange{0, (frames - 1) * step, step};
  const JobId id = farm_->submit(spec, now_);
  sizes_[id] = size;
  for (std::uint32_t i = 1; i < frames; ++i) to_come_[id].push_back(spec.frames->at(i));
}

void Chaos::command_a_job() {
  if (sizes_.empty()) return;
  const JobId job = std::next(sizes_.begin(), static_cast<std::ptrdiff_t>(chance(sizes_.size())))->first;
  for (const Player& player : players_) remember(player.worker);
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

void Chaos::remove(JobId job) {
  const std::optional<JobView> view = farm_->job(job, now_);
  const bool may_go = view && (view->state == JobState::done || has_ended(job));
  ASSERT_EQ(farm_->remove(job), may_go);
  if (may_go) removed_.insert(job);
}

void Chaos::send_a_frame() {
  if (to_come_.empty()) return;
  const auto next = std::next(to_come_.begin(), static_cast<std::ptrdiff_t>(chance(to_come_.size())));
  const auto [job, frames] = *next;
  const bool goes_on = add_frame(*farm_, job, frames.front(), now_);
  ASSERT_EQ(goes_on, !has_ended(job));
  next->second.erase(next->second.begin());
  if (!goes_on || next->second.empty()) to_come_.erase(next);
}

void Chaos::build_again() {
  std::ranges::move(farm_->take_records(), std::back_inserter(records_));
  expect_same(*farm_, Farm({}, past_of(records_), now_), now_);
  for (const Player& player : players_) keep_what_is_held(player);
  farm_ = std::make_unique<Farm>(FarmLimits{}, past_of(records_), now_);
  players_.clear(), once_held_.clear(), refused_.clear();
  join();
}

bool Chaos::has_ended(JobId job) const {
  if (removed_.contains(job)) return true;
  const JobState state = farm_->job(job, now_)->state;
  return state == JobState::cancelled || state == JobState::failed;
}

bool Chaos::is_verified(JobId job) const {
  return !std::holds_alternative<std::monostate>(farm_->job(job, now_)->verification);
}

}  // namespace rayfarm
