#include "master/http/guests.h"

#include <algorithm>
#include <map>
#include <string_view>

namespace rayfarm {

bool Guests::send_away_one() {
  std::map<std::string_view, std::size_t> held;
  std::size_t most = 0;
  for (const Guest& guest : all_)
    if (!guest.is_leaving) most = std::max(most, ++held[guest.who]);
  const auto oldest =
      std::ranges::find_if(all_, [&](const Guest& g) { return !g.is_leaving && held[g.who] == most; });
  if (oldest == all_.end()) return false;
  oldest->is_leaving = true;
  oldest->socket.shut_down();
  return true;
}

}  // namespace rayfarm
