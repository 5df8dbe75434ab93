// How far a job's pixels are believed.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace rayfarm {

/// Of a worker's tiles so many are rendered by somebody else, too: all until ten in a row were right, then this share.
struct Audit {
  double share = 0;  // 0 < share <= 1
  bool operator==(const Audit&) const = default;
};
/// Each tile is rendered with the same bits by so many.
struct Quorum {
  std::uint32_t workers = 2;  // 2 to 16
  bool operator==(const Quorum&) const = default;
};
using Verification = std::variant<std::monostate, Audit, Quorum>;

/// "none", "audit=0.05" or "quorum=2". Throws SettingsError.
Verification parse_verification(std::string_view text);
std::string text_of(const Verification& verification);

/// What is known of a worker's honesty, by its name. Source: BOINC's adaptive replication (D. P. Anderson, BOINC: A
/// Platform for Volunteer Computing, J. Grid Computing 18, 2020, section 4.1).
struct Trust {
  std::uint32_t good_in_a_row = 0;  // tiles in which somebody else agreed
  std::uint32_t mismatches = 0;     // in which it was wrong
  bool operator==(const Trust&) const = default;
};
constexpr std::uint32_t most_mismatches = 2;  // then it is banned

/// How many must agree on a tile that such a worker has rendered; 1: nobody is asked. `dice` is evenly spread over 64
/// bits, and nothing that the worker can foresee.
///
/// Of a worker that is trusted and lies in each tile, k tiles are taken before it is caught with probability
/// (1 - share)^k.
std::uint32_t opinions_wanted(const Verification& verification, const Trust& trust, std::uint64_t dice);

}  // namespace rayfarm
