// A disk that is soon full.
#pragma once
#include <cstddef>
#include <filesystem>

namespace rayfarm {

/// From now on this process and its children see a disk of so many bytes in this folder. errno when this machine allows
/// none.
int enter_small_disk(const std::filesystem::path& folder, std::size_t bytes);

}  // namespace rayfarm
