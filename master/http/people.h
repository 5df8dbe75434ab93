// Who asks, and whether they may: what a request shows (a token, a browser's cookie, that it comes from this PC) and
// what its route asks for.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "common/net/exposure.h"
#include "master/access/access.h"
#include "master/http/message.h"

namespace rayfarm {

struct Asker {
  Role role = Role::viewer;
  std::string shown{};  // the token or cookie; empty: came without
};

/// None: whoever it is, they are nobody here. `access` may be null. `tell` takes why, for the log.
std::optional<Asker> asker_of(const ApiRequest& request, Exposure exposure, Access* access,
                              const std::function<void(const std::string&)>& tell);
/// What they get instead of an answer when they are nobody, or too little for it; nothing when they may.
std::optional<ApiResponse> denial(const std::optional<Asker>& asker, Role needed);

/// What a browser shows of itself; empty: nothing.
std::string session_shown(const ApiRequest& request);
// The session cookie as the server sets it, and takes it away.
std::string session_cookie(const std::string& token, bool is_encrypted);
std::string no_session_cookie(bool is_encrypted);

}  // namespace rayfarm
