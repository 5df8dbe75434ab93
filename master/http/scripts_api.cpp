// Scenes that the master offers, and scripts that people bring.
#include <nlohmann/json.hpp>

#include "master/http/route.h"
#include "master/http/script_submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

constexpr std::uint64_t script_limit = 2 * longest_script + command_limit;  // escaped, as JSON

ApiResponse list_scenes(const Call& call) {
  json scenes = json::array();
  for (const OfferedScene& scene : call.doors.scenes.scenes()) scenes.push_back(to_json(scene));
  return shown({{"scenes", std::move(scenes)}});
}

ApiResponse look_at_script(const Call& call) {
  return shown(to_json(script_facts(body_of(call), call.request.has_left)));
}

constexpr Route routes[]{
    {"GET", "/api/v1/scenes", list_scenes, Work::look},
    {"POST", "/api/v1/scripts", look_at_script, Work::look, script_limit},
};

}  // namespace

std::span<const Route> script_routes() { return routes; }

}  // namespace rayfarm
