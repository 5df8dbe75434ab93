// What can still be read of a damaged journal, in a new one.
#pragma once
#include <filesystem>

namespace rayfarm {

/// Notes that the journal is damaged: it is to be mended when it is opened next.
void note_damage(const std::filesystem::path& journal);

/// True: it is noted that the journal is damaged, or it was being mended when the process ended.
bool wants_mending(const std::filesystem::path& journal);

/// Writes all rows that can be read to a new file, which takes the journal's place; the damaged one stays beside it, as
/// NAME.damaged or with a number after it. What lies on a damaged page is missing then, as if it had never been there.
/// Takes as long as the file takes to be read, and as much room as it has. Nobody has the journal open. When the process
/// ends at any instant, the journal is the old one or the new one, and the next call finishes what was begun. Throws
/// SQLite::Exception and std::runtime_error when nothing could be done; then the journal is as it was.
void salvage(const std::filesystem::path& journal);

}  // namespace rayfarm
