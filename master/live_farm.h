// The farm at work: with a clock and a journal, which it does not have itself, and its events in the log.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "master/event_log.h"
#include "master/farm.h"
#include "master/farm_record.h"

namespace rayfarm {

class Journal;

/// All calls are made from one thread, but for one.
class LiveFarm {
 public:
  /// Forgotten with the process, unless a journal is opened.
  explicit LiveFarm(FarmLimits limits = {});  // the secret among them it draws itself
  ~LiveFarm();
  LiveFarm(const LiveFarm&) = delete;

  /// The farm becomes what the journal says; what changes is written there by keep(). Before anything else is asked.
  /// Throws JournalError.
  void open(const std::filesystem::path& journal);

  /// What call(farm, now) gives. What happened in the farm goes to the log.
  template <class Call>
  std::invoke_result_t<Call, Farm&, FarmTime> apply(Call&& call) {
    const LogAtEnd log{*this};
    return call(farm_, now());
  }

  /// Called when there is something to keep that was not there before: so that all changes of one turn of an event loop
  /// are written at once, at its end.
  void when_changed(std::function<void()> call) { when_changed_ = std::move(call); }
  /// Writes to the journal what changed, and returns when it will outlive the process. When that cannot be done, all jobs
  /// are paused and say why; what was not written is kept and tried again when there is more, and each second. When the
  /// journal is at something else, a tick will do it.
  void keep();
  /// Returns when all that was kept will outlive the power, too, or why it, or what happened before, will not. From any
  /// thread, after open().
  std::optional<std::string> until_synced();
  /// What the farm and its journal do from time to time; called ten times a second.
  void tick();
  /// Called at the end of the next keep() that has nothing left to write, or with the reason if that failed.
  void once_kept(std::function<void(const std::optional<std::string>& fault)> told) {
    waiting_.push_back(std::move(told));
  }

  /// What happened beside the farm.
  void note(FarmEvent event);
  const EventLog& log() const { return log_; }

 private:
  struct LogAtEnd {
    LiveFarm& live;
    ~LogAtEnd();
  };
  FarmTime now() const;
  void take_news();
  /// Why it failed.
  std::optional<std::string> write();
  void tidy();
  void pause_all(const std::string& why);

  FarmTime clock_offset_;  // farm's time minus that of the steady clock
  std::unique_ptr<Journal> journal_;
  FarmLimits limits_;
  Farm farm_;
  EventLog log_;
  std::vector<FarmRecord> unwritten_;
  std::size_t tried_ = 0;    // so many of them could not be written
  int ticks_ = 0;            // since then
  bool is_late_ = false;     // the journal was at something else
  int late_ = 0;             // for so many tries
  bool is_writable_ = true;  // no failure since the last write
  std::string untidy_;       // what was said last of why nothing can be deleted
  std::function<void()> when_changed_ = [] {};
  std::vector<std::function<void(const std::optional<std::string>&)>> waiting_;
  std::mutex mutex_;
  std::optional<std::string> behind_;  // why not all is written; guarded by it
};

}  // namespace rayfarm
