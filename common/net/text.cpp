#include "common/net/text.h"

#include <cstddef>
#include <cstdint>

namespace rayfarm {
namespace {

/// Bytes of the sequence that starts with `lead`; 0 when none does.
std::size_t sequence_length(std::uint8_t lead) {
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead < 0xE0) return 2;
  if (lead >= 0xE0 && lead < 0xF0) return 3;
  if (lead >= 0xF0 && lead < 0xF5) return 4;
  return 0;
}

/// The smallest code point that needs a sequence of this length.
constexpr char32_t first_of_length[] = {0, 0, 0x80, 0x800, 0x10000};

/// The last two end lines, too.
bool is_control(char32_t c) { return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x2028 || c == 0x2029; }

}  // namespace

bool is_plain_text(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto lead = static_cast<std::uint8_t>(text[at]);
    const std::size_t length = sequence_length(lead);
    if (length == 0 || length > text.size() - at) return false;
    char32_t point = length == 1 ? lead : lead & (0x7Fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
      const auto byte = static_cast<std::uint8_t>(text[at + i]);
      if ((byte & 0xC0) != 0x80) return false;
      point = point << 6 | (byte & 0x3F);
    }
    const bool surrogate = point >= 0xD800 && point < 0xE000;
    if (point < first_of_length[length] || point > 0x10FFFF || surrogate || is_control(point)) return false;
    at += length;
  }
  return true;
}

}  // namespace rayfarm
