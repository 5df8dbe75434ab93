// What says what this is.
#include <nlohmann/json.hpp>

#include "master/access/access.h"
#include "master/http/assets.h"
#include "master/http/people.h"
#include "master/http/route.h"

namespace rayfarm {
namespace {

ApiResponse show_version(const Call&) {
  return shown({{"version", RAYFARM_VERSION}, {"api", 1}, {"protocol", protocol_version}});
}

ApiResponse show_openapi(const Call&) { return {200, "application/json", Body::lasting(openapi_json)}; }

ApiResponse refuse_plain_live(const Call&) {
  return error_response(426, "this is a WebSocket: ask for the upgrade");
}

/// A browser becomes somebody. Why it does not, only the log says.
ApiResponse log_in(const Call& call) {
  const auto code = call.query.find("code");
  if (code == call.query.end() || !call.doors.access) throw ApiError(404, "this is no login link");
  try {
    const Issued session =
        call.doors.access->log_in(code->second, call.request.from, std::chrono::system_clock::now());
    ApiResponse to_app{303, "text/plain", "logged in\n"};
    to_app.cookie = session_cookie(text_of(session.token), call.request.is_encrypted);
    to_app.location = "/";
    return to_app;
  } catch (const AccessRefused& refused) {
    call.doors.master.tell("no login at " + call.request.from + ": " + refused.what());
    throw ApiError(403, "this login link is not good, or no longer: ask for a new one");
  }
}

/// As with a link, for who has a token: the browser keeps it where no page's script can read it.
ApiResponse log_in_with_token(const Call& call) {
  const nlohmann::json body = body_of(call);
  if (body.size() != 1 || !body.contains("token") || !body["token"].is_string())
    throw ApiError(422, "a login brings a token, and nothing else");
  if (!call.doors.access) throw ApiError(409, "this master keeps no keys, so there are no tokens");
  try {
    const std::string token = body["token"];
    const Credential person =
        call.doors.access->check_person(token, call.request.from, std::chrono::system_clock::now());
    ApiResponse welcome = shown({{"role", name_of(person.role)}, {"name", person.name}});
    welcome.cookie = session_cookie(text_of(parse_token(token)), call.request.is_encrypted);
    return welcome;
  } catch (const AccessRefused& refused) {
    call.doors.master.tell("no login at " + call.request.from + ": " + refused.what());
    throw ApiError(403, "this token is not good, or no longer: ask for a new one");
  }
}

constexpr Route routes[]{
    {"GET", "/api/v1/version", show_version, Work::command, command_limit, Needs::nothing},
    {"GET", "/api/v1/openapi.json", show_openapi, Work::command, command_limit, Needs::nothing},
    {"GET", "/api/v1/live", refuse_plain_live},
    {"GET", "/login?code", log_in, Work::command, command_limit, Needs::nothing},
    {"POST", "/api/v1/login", log_in_with_token, Work::command, command_limit, Needs::nothing},
};

}  // namespace

std::span<const Route> page_routes() { return routes; }

}  // namespace rayfarm
