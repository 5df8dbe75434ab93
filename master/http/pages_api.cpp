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

constexpr Route routes[]{
    {"GET", "/api/v1/version", show_version},
    {"GET", "/api/v1/openapi.json", show_openapi},
};

}  // namespace

std::span<const Route> page_routes() { return routes; }

}  // namespace rayfarm
