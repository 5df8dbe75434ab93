#include "master/http/guests.h"

#include <sys/socket.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace rayfarm {

bool Guests::send_away_one() {
  std::map<std::string_view, std::size_t> held;
  for (const Guest& guest : all_)
    if (!guest.is_leaving) ++held[guest.who];
  if (held.empty()) return false;
  const auto most = std::ranges::max_element(held, {}, [](const auto& of_one) { return of_one.second; });
  const auto oldest = std::ranges::find_if(
      all_, [&](const Guest& guest) { return !guest.is_leaving && guest.who == most->first; });
  oldest->is_leaving = true;
  ::shutdown(oldest->socket, SHUT_RDWR);
  return true;
}

}  // namespace rayfarm
