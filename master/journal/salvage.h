// What can still be read of a damaged journal, in a new one.
#pragma once
#include <filesystem>

namespace rayfarm {

/// Beside the journal while it is known to be damaged: it is mended when it is opened next.
std::filesystem::path note_of_damage(const std::filesystem::path& journal);

/// Writes all rows that can be read to a new file, which takes the journal's place; the damaged one stays beside it.
/// What lies on a damaged page is missing then, as if it had never been there. Takes as long as the file takes to be
/// read. Nobody has the journal open. Returns where the damaged one is. Throws SQLite::Exception and
/// std::filesystem::filesystem_error when nothing could be done; then the journal is as it was.
std::filesystem::path salvage(const std::filesystem::path& journal);

}  // namespace rayfarm
