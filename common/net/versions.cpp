#include <algorithm>

#include "common/net/messages.h"

namespace rayfarm {

std::optional<Versions> common_versions(const Versions& a, const Versions& b) {
  const std::uint16_t newest = std::min(a.newest, b.newest);
  if (newest < std::max(a.oldest, b.oldest)) return std::nullopt;
  return Versions{newest, newest, a.capabilities & b.capabilities};
}

}  // namespace rayfarm
