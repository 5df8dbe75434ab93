// Numbers, times and tables as people read them.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace rayfarm {

std::string short_count(double n);                      // 950, 9.8 k, 12.3 M, 4.2 G
std::string clock_text(std::chrono::seconds duration);  // 00:41, 1:02:03
std::string percent(std::uint64_t part, std::uint64_t whole);
std::string share(std::uint64_t part, std::uint64_t whole);  // "45.8%": rounded, which percent() never is up

/// Left-aligned columns as wide as their widest cell, two spaces apart; each row ends in a newline, the first
/// is the heading. All rows have as many cells.
std::string table(const std::vector<std::vector<std::string>>& rows);

/// Text from elsewhere (names, messages) without control characters, which could move the cursor or fake a
/// line.
std::string printable(const std::string& text);

}  // namespace rayfarm
