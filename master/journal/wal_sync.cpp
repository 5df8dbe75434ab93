#include "master/journal/wal_sync.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "master/journal/database.h"

namespace rayfarm {
namespace {

constexpr auto interval = std::chrono::milliseconds(100);    // of syncs
constexpr auto patience = std::chrono::milliseconds(200);    // with a disk that had a fault
constexpr auto long_patience = std::chrono::seconds(10);     // with one that is slow
constexpr int patience_with_readers_ms = 200;                // of whom the log cannot be emptied under
constexpr auto between_emptyings = std::chrono::seconds(2);  // that did not work
constexpr std::int64_t large_log = 4 << 20;                  // bytes: then it is moved into the file
constexpr std::int64_t huge_log = 16 << 20;                  // bytes: then writers wait until it is empty

/// The disk says so once: a file that could not be synced counts as synced the next time.
struct WriteLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::filesystem::path log_of(const std::filesystem::path& journal) { return journal.string() + "-wal"; }

bool has_content(const std::filesystem::path& file) {
  std::error_code missing;
  const std::uintmax_t size = std::filesystem::file_size(file, missing);
  return !missing && size > 0;
}

std::filesystem::path mark_of(const std::filesystem::path& journal) { return journal.string() + "-mark"; }

/// Twice, so that a mark that was not written whole is none.
void put_mark(const std::filesystem::path& journal, std::int64_t writes) {
  const std::array<std::int64_t, 2> mark{writes, ~writes};
  const std::filesystem::path file = mark_of(journal);
  const int opened = open(file.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
  const bool is_put = opened >= 0 && pwrite(opened, mark.data(), sizeof mark, 0) == sizeof mark;
  const int error = errno;
  if (opened >= 0) close(opened);
  if (!is_put) throw std::runtime_error(file.string() + ": " + std::strerror(error));
}

/// False: somebody else reads or writes, the next time will do. A statement, since sqlite3_wal_checkpoint_v2() does nothing
/// in a connection that has not read yet, and says that all is well.
bool empty_log(const std::filesystem::path& journal, const char* how) {
  SQLite::Database database(journal.string(), SQLite::OPEN_READWRITE, patience_with_readers_ms);
  SQLite::Statement checkpoint(database, std::string("PRAGMA wal_checkpoint(") + how + ")");
  checkpoint.executeStep();
  const bool is_busy = checkpoint.getColumn(0).getInt() != 0;
  return !is_busy;
}

}  // namespace

/// Closing it drops no lock: SQLite locks the other two of its files.
void sync_to_disk(const std::filesystem::path& file) {
  const int opened = open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (opened < 0 && errno == ENOENT) return;
  if (opened < 0) throw std::runtime_error(file.string() + ": " + std::strerror(errno));
  const bool is_synced = fdatasync(opened) == 0;
  const int error = errno;
  close(opened);
  if (!is_synced) throw WriteLost(file.string() + ": " + std::strerror(error));
}

std::int64_t marked_writes(const std::filesystem::path& journal) {
  std::array<std::int64_t, 2> mark{};
  std::ifstream(mark_of(journal), std::ios::binary).read(reinterpret_cast<char*>(mark.data()), sizeof mark);
  return mark[1] == ~mark[0] ? mark[0] : 0;
}

WalSync::WalSync(std::filesystem::path journal)
    : journal_(std::move(journal)),
      may_have_hole_(has_content(log_of(journal_))),
      thread_([this] { work(); }) {}

WalSync::~WalSync() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  news_.notify_one();
  hurry_.notify_one();
  thread_.join();
}

void WalSync::wake(Written written) {
  {
    const std::lock_guard lock(mutex_);
    written_ = written;
  }
  news_.notify_one();
}

std::optional<std::string> WalSync::take_fault() {
  std::unique_lock lock(mutex_);
  if (loss_) return std::exchange(loss_, std::nullopt);
  if (!fault_) return std::nullopt;
  const std::int64_t mine = ++asked_;
  hurry_.notify_one();
  ended_.wait_for(lock, patience, [&] { return answered_ >= mine || !fault_; });
  return fault_;
}

std::optional<std::string> WalSync::until_synced() {
  std::unique_lock lock(mutex_);
  const std::int64_t all = written_.writes;
  if (synced_ >= all) return std::nullopt;
  const std::int64_t mine = ++asked_;
  hurry_.notify_one();
  ended_.wait_for(lock, long_patience, [&] { return answered_ >= mine || synced_ >= all; });
  if (synced_ >= all) return std::nullopt;
  return fault_ ? fault_ : "the disk of " + journal_.string() + " takes more than 10 s to keep it";
}

void WalSync::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    news_.wait(lock, [this] { return written_.writes != synced_ || is_ending_; });
    const bool was_last = is_ending_;
    if (synced_ != written_.writes) try_to_sync(lock);
    if (was_last) return;
    hurry_.wait_for(lock, interval, [this] { return is_ending_ || asked_ != answered_; });
  }
}

/// What fails is tried again.
void WalSync::try_to_sync(std::unique_lock<std::mutex>& lock) {
  const Written written = written_;
  const std::int64_t asked = asked_;
  std::optional<std::string> fault, loss;
  lock.unlock();
  try {
    sync(written);
  } catch (const WriteLost& error) {
    fault = loss = error.what();
  } catch (const std::exception& error) {
    fault = error.what();
  }
  lock.lock();
  if (!fault) synced_ = written.writes;
  if (loss) loss_ = loss;
  fault_ = fault;
  answered_ = asked;
  ended_.notify_all();
}

void WalSync::sync(Written written) {
  try {
    sync_to_disk(log_of(journal_));
  } catch (const WriteLost&) {
    has_hole_ = true;
    throw;
  }
  if ((has_hole_ || may_have_hole_) && try_to_empty()) {
    sync_to_disk(log_of(journal_));  // the end of the old one, or it may come back up to its hole
    has_hole_ = may_have_hole_ = false;
  }
  if (has_hole_) throw std::runtime_error(journal_.string() + ": its log has a hole, and somebody reads it");
  put_mark(journal_, written.writes);
  if (written.log_size < large_log) return;
  empty_log(journal_, "PASSIVE");
  if (written.log_size >= huge_log) try_to_empty();
}

/// Nobody can write while this waits for who reads.
bool WalSync::try_to_empty() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_emptying_) return false;
  const bool is_empty = empty_log(journal_, "TRUNCATE");
  if (!is_empty) next_emptying_ = now + between_emptyings;
  return is_empty;
}

}  // namespace rayfarm
