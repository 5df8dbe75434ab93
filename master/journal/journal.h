// What a farm must not forget, on disk: SQLite in WAL mode, in one file of its own.
//
// What write() has written survives the end of the process at any instant; what is older than 100 ms also that of the
// power, as a thread of the journal's own syncs the write-ahead log. Scenes and assets are kept once, by hash; pixels
// compressed; both, and every row that a picture depends on, with a checksum: what is damaged is left out, never taken
// for sound. A log that lost its end is noticed, too. A file that is damaged as such is mended when it is opened: what can
// be read is written anew. What the farm drops is deleted bit by bit, as a large
// picture takes seconds, and its place is used again. Where more than a third of the file is free, it is made smaller
// (one that was made before rayfarm did so keeps its size).
//
// Opening costs a few microseconds a tile: pixels are read when they are needed.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "master/farm_record.h"

namespace rayfarm {

/// The message names the file, what is wrong with it, and what to do.
struct JournalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// All calls are made from one thread, but for one.
class Journal {
 public:
  /// Makes the file if it is missing. Throws JournalError when it cannot be used: not writable, no journal, of a newer
  /// version, damaged at its root.
  explicit Journal(const std::filesystem::path& file);
  /// The next one knows that this was no crash.
  ~Journal();

  struct Opened {
    FarmPast past;                      // reads from this journal, which must live as long
    std::vector<JobId> suspects;        // that were being rendered at both of the last two crashes
    std::vector<std::string> warnings;  // damage
    bool is_cut = false;                // the last changes are lost
    FarmTime latest{};                  // no time in the records is later
  };
  Opened read();

  /// All of them or, when it throws JournalError, none: to be written again later. False: none, as the log is just being
  /// emptied; that takes as long as the disk is slow.
  [[nodiscard]] bool write(std::span<const FarmRecord> records);
  /// Returns when all that was written survives also the end of the power, or why it does not. From any thread.
  std::optional<std::string> until_synced();
  /// A few milliseconds of what is left to do when nothing else is: deleting, making the file smaller. Called ten times a
  /// second. Throws JournalError.
  void tidy();

 private:
  void mend();
  void mend_file();

  struct State;
  const std::filesystem::path file_;
  std::unique_ptr<State> state_;
  bool was_mended_ = false;
};

}  // namespace rayfarm
