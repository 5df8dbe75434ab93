// Makes what was committed survive the end of the power: syncs a journal's write-ahead log, and moves it into the
// journal's file when it has grown, on a thread of its own.
//
// SQLite takes a log as far as it is whole and says nothing of the rest. So the number of the last write that was synced
// stands in a small file of its own, the mark: a journal that has fewer was damaged.
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace rayfarm {

/// Nothing when there is no such file. Throws std::runtime_error when it is not on the disk now.
void sync_to_disk(const std::filesystem::path& file);

/// How many writes were synced; 0 when nobody knows.
std::int64_t marked_writes(const std::filesystem::path& journal);

class WalSync {
 public:
  /// The journal is open and stays so.
  explicit WalSync(std::filesystem::path journal);
  /// After a last sync.
  ~WalSync();
  WalSync(const WalSync&) = delete;

  struct Written {
    std::int64_t writes = 0;    // in the journal's life
    std::int64_t log_size = 0;  // bytes of them that are in the log
  };
  /// So much was committed; it will be synced within 100 ms, or as soon as the disk allows.
  void wake(Written written);
  /// Returns when all that was committed is synced, which begins at once; or why it is not. From any thread.
  std::optional<std::string> until_synced();
  /// Why the disk does not take what was committed, by a try that begins now; or why it lost a write, which it says once
  /// and so do we.
  std::optional<std::string> take_fault();

 private:
  void work();
  void sync(Written written);
  void try_to_sync(std::unique_lock<std::mutex>& lock);
  bool try_to_empty();

  const std::filesystem::path journal_;
  std::mutex mutex_;
  std::condition_variable news_;   // something is to be synced
  std::condition_variable hurry_;  // at once
  std::condition_variable ended_;  // a try
  Written written_;
  std::int64_t synced_ = 0;                // writes
  std::int64_t asked_ = 0, answered_ = 0;  // tries that are not to wait
  bool is_ending_ = false;
  std::optional<std::string> fault_;  // of the last try
  std::optional<std::string> loss_;   // not told yet
  // Of the thread alone.
  bool has_hole_ = false;  // the log, where the disk lost a write: what follows would not be read again
  bool may_have_hole_;     // as it is another life's
  std::chrono::steady_clock::time_point next_emptying_;
  std::thread thread_;
};

}  // namespace rayfarm
