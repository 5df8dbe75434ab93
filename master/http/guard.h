// Who may speak to the HTTP API: nobody but this PC's own programs and pages that the master itself served.
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
  std::string pc_name;  // the name under which others know this PC
};

/// Why the request must not be answered, if so. Needs the header only.
std::optional<ApiResponse> refusal(const ApiRequest& request, const ListenAddress& listening);

}  // namespace rayfarm
