#include "master/live_farm.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <random>
#include <thread>

#include "master/journal/journal.h"

namespace rayfarm {
namespace {

constexpr int ticks_between_tries = 10;  // of a journal that cannot be written: a second
constexpr int ticks_late = 50;           // of a journal that is at something else: 5 s
constexpr std::chrono::milliseconds a_tick{100};

std::uint64_t drawn() {
  std::random_device random;
  return std::uint64_t{random()} << 32 | random();
}

FarmTime steady_time() { return std::chrono::steady_clock::now().time_since_epoch(); }
/// Time goes on over the end of a process, and of the PC.
FarmTime wall_time() { return std::chrono::system_clock::now().time_since_epoch(); }

FarmLimits with_secret(FarmLimits limits) {
  limits.secret = drawn();
  return limits;
}

}  // namespace

LiveFarm::LiveFarm(FarmLimits limits)
    : clock_offset_(wall_time() - steady_time()), limits_(with_secret(limits)), farm_(limits_) {}

void LiveFarm::open(const std::filesystem::path& journal) {
  journal_ = std::make_unique<Journal>(journal);
  Journal::Opened opened = journal_->read();
  clock_offset_ = std::max(wall_time(), opened.latest) - steady_time();
  for (const std::string& damage : opened.warnings) note({true, damage, {}});
  farm_ = Farm(limits_, std::move(opened.past), now());
  for (const JobId job : opened.suspects) {
    const std::string number = std::to_string(static_cast<std::uint64_t>(job));
    apply([&](Farm& farm, FarmTime now) {
      farm.pause(job, now,
                 "it was being rendered when the master crashed, two times in a row; rayfarm resume " +
                     number + " goes on with it");
    });
  }
  if (opened.is_cut)
    pause_all(
        "the end of the journal was damaged on the disk; resume it, and what is missing is rendered again");
  take_news();
  keep();
}

LiveFarm::~LiveFarm() {
  do {
    is_late_ = false;
    keep();
    if (is_late_) std::this_thread::sleep_for(a_tick);
  } while (is_late_);
}

FarmTime LiveFarm::now() const { return steady_time() + clock_offset_; }

void LiveFarm::note(FarmEvent event) {
  spdlog::log(event.warning ? spdlog::level::warn : spdlog::level::info, "{}", event.text);
  log_.add(std::move(event), now());
}

LiveFarm::LogAtEnd::~LogAtEnd() {
  const bool was_kept = live.unwritten_.size() == live.tried_;
  live.take_news();
  if (was_kept && live.unwritten_.size() != live.tried_) live.when_changed_();
}

void LiveFarm::take_news() {
  for (FarmEvent& event : farm_.take_events()) note(std::move(event));
  std::vector<FarmRecord> records = farm_.take_records();
  if (journal_) std::ranges::move(records, std::back_inserter(unwritten_));
}

void LiveFarm::keep() {
  if (is_late_) return;
  std::optional<std::string> fault;
  if (unwritten_.size() != tried_) fault = write();
  if (is_late_) return;
  for (const auto& told : std::exchange(waiting_, {})) told(fault);
}

std::optional<std::string> LiveFarm::until_synced() {
  {
    const std::lock_guard lock(mutex_);
    if (behind_) return behind_;
  }
  return journal_ ? journal_->until_synced() : std::nullopt;
}

void LiveFarm::tick() {
  apply([](Farm& farm, FarmTime now) { farm.tick(now); });
  if (std::exchange(is_late_, false)) keep();
  if (tried_ != 0 && ++ticks_ >= ticks_between_tries) write();
  if (journal_ && is_writable_ && !is_late_) tidy();
}

void LiveFarm::tidy() try {
  journal_->tidy();
  untidy_.clear();
} catch (const JournalError& error) {
  is_writable_ = false;
  if (std::exchange(untidy_, error.what()) != error.what()) note({true, untidy_, {}});
}

std::optional<std::string> LiveFarm::write() {
  std::optional<std::string> fault;
  try {
    if (!journal_->write(unwritten_)) {
      is_late_ = ++late_ < ticks_late;
      if (is_late_) return std::nullopt;
      throw JournalError(
          "another program has locked the journal for seconds, or its disk hangs; end that, then resume the "
          "job");
    }
    late_ = 0;
    unwritten_.clear();
    is_writable_ = true;
    if (std::exchange(tried_, 0) != 0)
      note({false, "the journal is written again; resume the jobs that are paused", {}});
  } catch (const JournalError& error) {
    fault = error.what();
    if (tried_ == 0) note({true, *fault, {}});
    pause_all(*fault);
    tried_ = unwritten_.size(), ticks_ = late_ = 0;
    is_writable_ = false;
  }
  const std::lock_guard lock(mutex_);
  behind_ = fault;
  return fault;
}

void LiveFarm::pause_all(const std::string& why) {
  for (const JobView& job : farm_.jobs(now()))
    if (job.state == JobState::waiting || job.state == JobState::running) farm_.pause(job.id, now(), why);
  take_news();
}

}  // namespace rayfarm
