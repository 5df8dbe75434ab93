// What a file's name says of its kind.
#pragma once
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace rayfarm {

/// In lower case, as ".png"; empty when there is none.
inline std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace rayfarm
