// Meshes, Bezier surfaces and images of scenes that will be submitted: each is uploaded once.
#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "master/http/route.h"
#include "master/http/submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

ApiResponse look_for_asset(const Call& call) {
  const std::string& hash = call.arguments.at(0);
  return shown({{"hash", hash}, {"is_here", call.doors.assets.find(hash).has_value()}});
}

/// {data}: the asset's bytes in base64.
ApiResponse upload_asset(const Call& call) {
  const json body = body_of(call);
  if (!body.contains("data") || !body["data"].is_string() || body.size() != 1)
    throw ApiError(400, "data must be there, and nothing else: the encoded asset in base64");
  AssetData asset{"", std::make_shared<const Bytes>(from_base64(body["data"].get_ref<const std::string&>()))};
  asset.hash = sha256_hex(*asset.bytes);
  decode_asset(asset);  // throws unless it can be used
  const AssetData kept = call.doors.assets.add(std::move(asset));
  ApiResponse response = shown({{"hash", kept.hash}, {"is_here", true}});
  response.status = 201;
  return response;
}

constexpr Route routes[]{
    {"GET", "/api/v1/assets/{hash}", look_for_asset},
    {"POST", "/api/v1/assets", upload_asset, Work::script, submission_limit},
};

}  // namespace

std::span<const Route> asset_routes() { return routes; }

}  // namespace rayfarm
