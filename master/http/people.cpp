#include "master/http/people.h"

#include "master/http/guard.h"

namespace rayfarm {
namespace {

constexpr std::string_view bearer = "Bearer ";
constexpr std::string_view cookie_name = "rayfarm=";

std::string shown_by(const ApiRequest& request) {
  if (request.authorization.starts_with(bearer)) return request.authorization.substr(bearer.size());
  return session_shown(request);
}

std::string cookie_with(const std::string& value, int seconds, bool is_encrypted) {
  return std::string(cookie_name) + value +
         "; Path=/; HttpOnly; SameSite=Strict; Max-Age=" + std::to_string(seconds) +
         (is_encrypted ? "; Secure" : "");
}

}  // namespace

/// Of "a=1; rayfarm=XYZ; b=2": XYZ.
std::string session_shown(const ApiRequest& request) {
  std::string_view cookies = request.cookie;
  while (!cookies.empty()) {
    const std::string_view one = cookies.substr(0, cookies.find(';'));
    cookies.remove_prefix(std::min(one.size() + 1, cookies.size()));
    const std::string_view pair = one.substr(std::min(one.find_first_not_of(' '), one.size()));
    if (pair.starts_with(cookie_name)) return std::string(pair.substr(cookie_name.size()));
  }
  return "";
}

std::optional<Asker> asker_of(const ApiRequest& request, Exposure exposure, Access* access,
                              const std::function<void(const std::string&)>& tell) {
  const std::string shown = shown_by(request);
  if (!shown.empty() && access) try {
      return Asker{access->check_person(shown, request.from, std::chrono::system_clock::now()).role, shown};
    } catch (const AccessRefused& refused) {
      tell("nobody at " + request.from + ": " + refused.what());
    }
  const bool is_open =
      exposure == Exposure::insecure || (exposure == Exposure::loopback_only && is_from_this_pc(request));
  if (is_open) return Asker{Role::admin};
  return std::nullopt;
}

std::optional<ApiResponse> denial(const std::optional<Asker>& asker, Role needed) {
  if (!asker)
    return error_response(
        401,
        "log in first: an admin has links for browsers (rayfarm token new --role viewer --link) and "
        "tokens for programs (rayfarm token new --role artist, in RAYFARM_TOKEN_FILE)");
  if (asker->role < needed)
    return error_response(403, "this takes a token of role " + std::string(name_of(needed)) +
                                   ", yours is of role " + std::string(name_of(asker->role)));
  return std::nullopt;
}

std::string session_cookie(const std::string& token, bool is_encrypted) {
  constexpr int week = 7 * 24 * 3600;  // as long as a session
  return cookie_with(token, week, is_encrypted);
}

std::string no_session_cookie(bool is_encrypted) { return cookie_with("", 0, is_encrypted); }

}  // namespace rayfarm
