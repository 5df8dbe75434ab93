// A farm with a journal, and the same farm after the end of its process.
#pragma once
#include <SQLiteCpp/SQLiteCpp.h>

#include <functional>
#include <memory>
#include <optional>

#include "master/journal/journal.h"
#include "tests/master/farm/fake_worker.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {

constexpr int patience = 60'000;  // ms, with the journal's own connections, where a test looks into its file

class KeptFarm {
 public:
  explicit KeptFarm(FarmLimits limits = {}) : limits_(limits) { open(); }

  Farm& farm() { return *farm_; }
  std::filesystem::path file() const { return folder_ / "journal.db"; }
  const Journal::Opened& opened() const { return opened_; }

  void keep() {
    write();
    journal_->tidy();
  }
  void write() {
    for (const auto records = farm_->take_records(); !journal_->write(records);) {}
  }
  /// What was not kept is gone. The files are moved as they are: nobody closes them, as when the process is killed.
  void crash(const std::function<void(std::string& log)>& damage = {}) {
    std::filesystem::create_directory(folder_ / "after");
    copy_files(folder_ / "after");
    close();
    for (const char* name : {"journal.db", "journal.db-wal", "journal.db-shm"})
      std::filesystem::remove(folder_ / name);
    const std::filesystem::path log = folder_ / "after" / "journal.db-wal";
    if (damage) {
      std::string bytes = content_of(log);
      damage(bytes);
      put_content(log, bytes);
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "after"))
      std::filesystem::rename(entry.path(), folder_ / entry.path().filename());
    open();
  }
  void close() {
    farm_.reset();
    journal_.reset();
  }
  void open(FarmTime now = FarmTime{}) {
    journal_ = std::make_unique<Journal>(file());
    opened_ = journal_->read();
    farm_.emplace(limits_, opened_.past, std::max(now, opened_.latest));
  }

 private:
  /// As they are at one instant: while somebody else writes, the log is not emptied; and what is just moved from there into
  /// the file stays in it.
  void copy_files(const std::filesystem::path& to) {
    SQLite::Database other(file().string(), SQLite::OPEN_READWRITE, patience);
    const SQLite::Transaction writing(other, SQLite::TransactionBehavior::IMMEDIATE);
    for (const char* name : {"journal.db", "journal.db-wal"})
      if (std::filesystem::exists(folder_ / name)) std::filesystem::copy_file(folder_ / name, to / name);
  }

  ScratchFolder folder_;
  FarmLimits limits_;
  std::unique_ptr<Journal> journal_;
  Journal::Opened opened_;
  std::optional<Farm> farm_;
};

}  // namespace rayfarm
