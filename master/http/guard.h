// From where one may speak to the HTTP API: from programs, and from pages that the master itself served.
//
// A browser on this PC runs pages from everywhere. Such a page can send requests to 127.0.0.1 (so Origin and
// Sec-Fetch-Site are looked at), can do simple POSTs without being asked (so these must be application/json,
// which needs permission first), and can have its own host name point to 127.0.0.1 (DNS rebinding, so Host is
// looked at).
#pragma once
#include <optional>
#include <string>

#include "master/http/message.h"

namespace rayfarm {

struct ListenAddress {
  std::string address;  // numeric
  bool loopback = true;
  std::string pc_name;               // the name under which others know this PC
  std::vector<std::string> names{};  // others, in small letters: of the certificate that is shown
};

/// A program of this PC asks for itself: it came over loopback, asks for a loopback name, and no proxy says that it asks
/// for somebody else.
bool is_from_this_pc(const ApiRequest& request);

/// Why the request must not be answered, if so. Needs the header only.
std::optional<ApiResponse> refusal(const ApiRequest& request, const ListenAddress& listening);

}  // namespace rayfarm
