#include "master/verification.h"

#include <charconv>
#include <optional>

#include "common/render/settings.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t good_enough = 10;  // in a row: then a worker is trusted
constexpr std::uint32_t largest_quorum = 16;

template <class Number>
std::optional<Number> number_after(std::string_view word, std::string_view text) {
  if (!text.starts_with(word)) return std::nullopt;
  const char* const end = text.data() + text.size();
  Number number{};
  const auto [rest, fault] = std::from_chars(text.data() + word.size(), end, number);
  if (fault != std::errc{} || rest != end) return std::nullopt;
  return number;
}

}  // namespace

Verification parse_verification(std::string_view text) {
  if (text == "none") return std::monostate{};
  if (const auto share = number_after<double>("audit=", text); share && *share > 0 && *share <= 1)
    return Audit{*share};
  if (const auto workers = number_after<std::uint32_t>("quorum=", text);
      workers && *workers >= 2 && *workers <= largest_quorum)
    return Quorum{*workers};
  throw SettingsError("verify must be none, audit=P with a share 0 < P <= 1, or quorum=N with 2 to " +
                      std::to_string(largest_quorum) + " workers, not \"" + std::string(text) + "\"");
}

std::string text_of(const Verification& verification) {
  if (const auto* quorum = std::get_if<Quorum>(&verification))
    return "quorum=" + std::to_string(quorum->workers);
  const auto* audit = std::get_if<Audit>(&verification);
  if (!audit) return "none";
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, audit->share).ptr;
  return "audit=" + std::string(digits, end);
}

std::uint32_t opinions_wanted(const Verification& verification, const Trust& trust, std::uint64_t dice) {
  if (const auto* quorum = std::get_if<Quorum>(&verification)) return quorum->workers;
  const auto* audit = std::get_if<Audit>(&verification);
  if (!audit) return 1;
  const bool is_trusted = trust.good_in_a_row >= good_enough;
  return is_trusted && static_cast<double>(dice) * 0x1p-64 >= audit->share ? 1 : 2;
}

}  // namespace rayfarm
