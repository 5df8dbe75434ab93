// What workers do.
#include "tests/master/farm/chaos.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rayfarm {

using namespace std::chrono_literals;

void Chaos::run(int steps) {
  for (int i = 0; i < steps; ++i) {
    now_ += chance(100) == 0 ? 3s : std::chrono::milliseconds(chance(40));
    farm_->tick(now_);
    step();
    see_off_the_banned();
    check();
    if (testing::Test::HasFatalFailure()) return;
  }
}

void Chaos::step() {
  if (chance(100) == 0) return build_again();
  switch (chance(28)) {
    case 0:
      return join();
    case 1:
      return players_.size() > 1 ? leave(chance(players_.size())) : join();
    case 2:
      return submit();
    case 3:
      return command_a_job();
    case 4:
      return chance(4) == 0 ? ban_or_unban() : drain_or_undrain();
    case 5:
      return answer_late();
    case 6:
      return chance(2) == 0 ? break_the_rules() : fall_silent();
    case 7:
      return give_back();
    case 8:
    case 9:
      return send_a_frame();
    case 10:
      return players_.size() > 1 ? stop(chance(players_.size())) : join();
    case 11:
      return come_back();
    case 12:
      return players_.empty() ? join() : come_again(chance(players_.size()));
    default:
      return work();
  }
}

void Chaos::join() {
  if (players_.size() >= 8) return;
  ++names_;
  WorkerInfo info;
  info.name = (chance(4) == 0 ? "liar" : "pc") + std::to_string(names_);
  info.kind = chance(3) == 0 ? WorkerKind::local : WorkerKind::remote;
  info.threads = static_cast<std::uint32_t>(1 + chance(4));
  info.takes_pieces = chance(3) != 0;
  info.process = names_;
  join_as(info);
}

void Chaos::join_as(const WorkerInfo& info) {
  if (info.kind == WorkerKind::remote && farm_->objection_to(info.name)) return;
  players_.push_back({FakeWorker(*farm_, info, now_), info});
}

void Chaos::leave(std::size_t who) {
  keep_what_is_held(players_[who]);
  forget(who);
}

void Chaos::stop(std::size_t who) {
  remember(players_[who].worker);
  farm_->receive(players_[who].worker.id(), GiveBack{}, now_);
  forget(who);
}

void Chaos::forget(std::size_t who) {
  remember(players_[who].worker);
  farm_->remove_worker(players_[who].worker.id(), "gone", now_, chance(2) * 2s);
  players_.erase(players_.begin() + static_cast<std::ptrdiff_t>(who));
}

void Chaos::keep_what_is_held(const Player& player) {
  if (player.info.kind == WorkerKind::local) return;
  Memory memory{player.info, {}};
  for (const HeldAssignment& work : player.worker.held())
    if (!work.piece) memory.held.push_back({work, chance(2) == 0});
  memories_.push_back(std::move(memory));
}

void Chaos::come_back() {
  if (memories_.empty() || players_.size() >= 8) return;
  const auto which = memories_.begin() + static_cast<std::ptrdiff_t>(chance(memories_.size()));
  const Memory memory = *which;
  memories_.erase(which);
  const std::size_t before = players_.size();
  join_as(memory.info);
  if (players_.size() > before) say_what_is_held(memory.held);
}

void Chaos::say_what_is_held(const std::vector<HeldTile>& held) {
  for (const HeldTile& tile : held)
    if (tile.is_finished) returned_to_.insert(tile.work.job);
  farm_->receive(players_.back().worker.id(), Holds{held}, now_);
}

void Chaos::come_again(std::size_t who) {
  if (players_[who].info.kind == WorkerKind::local || farm_->objection_to(players_[who].info.name)) return;
  keep_what_is_held(players_[who]);
  const Memory memory = std::move(memories_.back());
  memories_.pop_back();
  remember(players_[who].worker);
  players_.erase(players_.begin() + static_cast<std::ptrdiff_t>(who));  // the farm removes it
  join_as(memory.info);
  say_what_is_held(memory.held);
}

void Chaos::fall_silent() {
  if (std::ranges::count_if(players_, &Player::is_mute) < 2 && !players_.empty())
    players_[chance(players_.size())].is_mute = true;
}

void Chaos::drain_or_undrain() {
  if (players_.empty()) return;
  const FakeWorker& worker = players_[chance(players_.size())].worker;
  remember(worker);
  if (chance(3) == 0)
    farm_->drain(worker.name(), now_);
  else
    farm_->undrain(worker.name(), now_);
}

void Chaos::ban_or_unban() {
  if (chance(2) == 0 && !farm_->banned().empty()) {
    farm_->unban(farm_->banned().front(), now_);
  } else if (!players_.empty()) {
    const FakeWorker& worker = players_[chance(players_.size())].worker;
    remember(worker);
    farm_->ban(worker.name(), now_);
  }
}

void Chaos::see_off_the_banned() {
  for (std::size_t i = players_.size(); i-- > 0;) {
    const auto messages = players_[i].worker.take_messages();
    if (std::ranges::any_of(messages, [](const auto& m) { return std::holds_alternative<Refused>(m); }))
      forget(i);
  }
}

void Chaos::work() {
  const std::size_t who = worker_with_work();
  if (who < players_.size()) hand_in(who, players_[who].worker.held()[0]);
}

void Chaos::hand_in(std::size_t who, const HeldAssignment work) {
  Player& player = players_[who];
  FakeWorker& worker = player.worker;
  const double seconds = 0.001 * static_cast<double>(chance(30));
  once_held_.emplace_back(worker.id(), work);
  worker.drop(work.lease);
  if (work.piece) return farm_->receive(worker.id(), rendered_piece(work, seconds), now_);
  Result result = rendered(work, sizes_.at(work.job), seconds);
  const bool may_lie = player.info.name.starts_with("liar") && player.info.kind == WorkerKind::remote;
  if (may_lie && is_verified(work.job) && chance(3) == 0) {  // each its own lie
    PassImage& image = result.images.back();
    image.rgb.back() += static_cast<float>(player.info.process);
    if (chance(2) == 0) image.counters.shadow += player.info.process;
  }
  farm_->receive(worker.id(), std::move(result), now_);
}

/// A result for a lease that was once somebody's: revoked, already answered, or still held by another.
void Chaos::answer_late() {
  if (players_.empty() || once_held_.empty()) return;
  const auto [holder, old] = once_held_[chance(once_held_.size())];
  const auto its =
      std::ranges::find_if(players_, [id = holder](const Player& p) { return p.worker.id() == id; });
  if (its == players_.end() && chance(8) != 0) return;
  const std::size_t who =
      its == players_.end() ? chance(players_.size()) : static_cast<std::size_t>(its - players_.begin());
  const FakeWorker& worker = players_[who].worker;
  if (std::ranges::count(worker.held(), old.lease, &Assignment::lease) != 0) return;
  try {
    if (old.piece)
      farm_->receive(worker.id(), rendered_piece(old), now_);
    else
      farm_->receive(worker.id(), rendered(old, sizes_.at(old.job)), now_);
  } catch (const WorkerError&) {
    leave(who);
  }
}

void Chaos::break_the_rules() {
  const std::size_t who = worker_with_work();
  if (who == players_.size()) return;
  FakeWorker& worker = players_[who].worker;
  const HeldAssignment held = worker.held()[0];
  PieceResult lie;
  if (held.piece)
    lie = rendered_piece(held);
  else
    lie.result = rendered(held, sizes_.at(held.job));
  switch (chance(3)) {
    case 0:
      lie.result.tile += 1;
      break;
    case 1:
      lie.result.images.pop_back();
      break;
    default:
      lie.result.images[0].rgb.push_back(1);
      break;
  }
  if (held.piece)
    EXPECT_THROW(farm_->receive(worker.id(), lie, now_), WorkerError);
  else
    EXPECT_THROW(farm_->receive(worker.id(), lie.result, now_), WorkerError);
  worker.drop(held.lease);
  leave(who);
}

void Chaos::give_back() {
  const std::size_t who = worker_with_work();
  if (who == players_.size()) return;
  FakeWorker& worker = players_[who].worker;
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

std::size_t Chaos::worker_with_work() {
  std::vector<std::size_t> busy;
  for (std::size_t i = 0; i < players_.size(); ++i)
    if (!players_[i].worker.held().empty() && !players_[i].is_mute) busy.push_back(i);
  return busy.empty() ? players_.size() : busy[chance(busy.size())];
}

void Chaos::remember(const FakeWorker& worker) {
  for (const HeldAssignment& work : worker.held()) once_held_.emplace_back(worker.id(), work);
}

}  // namespace rayfarm
