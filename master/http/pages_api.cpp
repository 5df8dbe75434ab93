// What says what this is.
#include <nlohmann/json.hpp>

#include "master/http/assets.h"
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

constexpr Route routes[]{
    {"GET", "/api/v1/version", show_version},
    {"GET", "/api/v1/openapi.json", show_openapi},
    {"GET", "/api/v1/live", refuse_plain_live},
};

}  // namespace

std::span<const Route> page_routes() { return routes; }

}  // namespace rayfarm
