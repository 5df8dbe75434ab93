// Files that only their owner may read: keys, and what secrets are known by.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace rayfarm {

/// Nothing when there is no such file. Throws std::runtime_error when it cannot be read, is over 64 MB, or other users
/// of the PC may read it, too.
std::optional<std::string> read_private_file(const std::filesystem::path& file);

/// Written beside it and renamed, with the rights 0600: the old content stays until the new one is on the disk. Throws
/// std::runtime_error.
void write_private_file(const std::filesystem::path& file, const std::string& content);

}  // namespace rayfarm
