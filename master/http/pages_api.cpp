// What says what this is.
#include <nlohmann/json.hpp>

#include "master/access/access.h"
#include "master/http/assets.h"
#include "master/http/people.h"
#include "master/http/route.h"

namespace rayfarm {
namespace {

using nlohmann::json;

ApiResponse show_version(const Call&) {
  return shown({{"version", RAYFARM_VERSION}, {"api", 1}, {"protocol", protocol_version}});
}

ApiResponse show_openapi(const Call&) { return {200, "application/json", Body::lasting(openapi_json)}; }

ApiResponse refuse_plain_live(const Call&) {
  return error_response(426, "this is a WebSocket: ask for the upgrade");
}

json to_json(const Credential& person) { return {{"role", name_of(person.role)}, {"name", person.name}}; }

/// {"code": "..."} of a login link, or {"token": "..."}: a browser becomes somebody, whom it remembers where no page's
/// script can read it. Why it does not, only the log says.
ApiResponse log_in(const Call& call) {
  const json body = body_of(call);
  const bool with_code = body.contains("code"), with_token = body.contains("token");
  if (body.size() != 1 || with_code == with_token || !body.begin()->is_string())
    throw ApiError(422, "a login brings a code or a token, and nothing else");
  if (!call.doors.access) throw ApiError(409, "this master keeps no keys, so there is no login");
  Access& access = *call.doors.access;
  const std::string secret = *body.begin(), &from = call.request.from;
  const WallTime now = std::chrono::system_clock::now();
  try {
    const Issued session =
        with_code ? access.log_in(secret, from, now) : access.log_in_with_token(secret, from, now);
    const Credential& made = session.credential;
    call.doors.master.note("session " + made.id + " of " + made.parent + " (" +
                           std::string(name_of(made.role)) + ") began at " + from);
    ApiResponse welcome = shown(to_json(made));
    welcome.cookie = session_cookie(text_of(session.token), call.request.is_encrypted);
    return welcome;
  } catch (const AccessRefused& refused) {
    call.doors.master.tell("no login at " + from + ": " + refused.what());
    throw ApiError(403, std::string(with_code ? "this login link" : "this token") +
                            " is not good, or no longer: ask for a new one");
  }
}

ApiResponse show_login(const Call& call) {
  std::optional<Credential> session;
  if (call.doors.access)
    session = call.doors.access->session(session_shown(call.request), std::chrono::system_clock::now());
  return shown({{"session", session ? to_json(*session) : json()}});
}

ApiResponse log_out(const Call& call) {
  if (call.doors.access)
    call.doors.access->log_out(session_shown(call.request), std::chrono::system_clock::now());
  ApiResponse farewell = shown(json::object());
  farewell.cookie = no_session_cookie(call.request.is_encrypted);
  return farewell;
}

constexpr Route routes[]{
    {"GET", "/api/v1/version", show_version, Work::command, command_limit, Needs::nothing},
    {"GET", "/api/v1/openapi.json", show_openapi, Work::command, command_limit, Needs::nothing},
    {"GET", "/api/v1/live", refuse_plain_live},
    {"GET", "/api/v1/login", show_login, Work::command, command_limit, Needs::nothing},
    {"POST", "/api/v1/login", log_in, Work::command, command_limit, Needs::nothing},
    {"POST", "/api/v1/logout", log_out, Work::command, command_limit, Needs::nothing},
};

}  // namespace

std::span<const Route> page_routes() { return routes; }

}  // namespace rayfarm
