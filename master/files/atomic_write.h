// A file appears whole or not at all.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>

namespace rayfarm {

/// Writes the bytes beside `file`, syncs them and renames: on any failure an old file is as it was and
/// nothing is left behind. Follows a symbolic link to its target. Throws FileError (image_file.h).
void write_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace rayfarm
