// Lengths of time as people type them.
#pragma once
#include <cstdint>
#include <string>

namespace rayfarm {

/// Of "90s", "30m", "1h" or "7d". Throws CommandError.
std::uint64_t seconds_in(const std::string& text);

}  // namespace rayfarm
