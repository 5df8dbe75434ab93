#include "master/script/suggestion.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace rayfarm {
namespace {

/// Levenshtein's distance; upper and lower case count as the same.
std::size_t distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i]) == lower(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string suggestion(std::string_view misspelt, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 40;  // nobody misspells more, and the distance costs length^2
  if (misspelt.size() > longest) return {};
  const std::string* nearest = nullptr;
  std::size_t least = misspelt.size() / 3 + 2;  // this many mistakes make another word
  for (const std::string& candidate : candidates) {
    if (candidate.size() > longest) continue;
    const std::size_t d = distance(misspelt, candidate);
    if (d < least && d < candidate.size()) nearest = &candidate, least = d;
  }
  return nearest ? ", did you mean '" + *nearest + "'?" : std::string{};
}

}  // namespace rayfarm
