#include "master/http/submission.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "common/net/text.h"
#include "master/http/settings_json.h"

namespace rayfarm {
namespace {

using nlohmann::json;

constexpr int deepest = 4;
constexpr int most_values = 200;
constexpr std::size_t longest_text = 1000;  // of names, bytes

std::string text_in(const json& body, const char* name) {
  const json value = body.value(name, json(""));
  if (!value.is_string()) throw ApiError(400, std::string(name) + " must be a text");
  const std::string text = value.get<std::string>();
  if (text.size() > longest_text) throw ApiError(400, std::string(name) + " is longer than 1000 bytes");
  if (!is_plain_text(text))  // it goes into the log
    throw ApiError(422, std::string(name) + " must be one line of text without control characters");
  return text;
}

bool flag_in(const json& body, const char* name) {
  const json value = body.value(name, json(false));
  if (!value.is_boolean()) throw ApiError(400, std::string(name) + " must be true or false");
  return value.get<bool>();
}

std::map<std::string, std::string> parameters_in(const json& body) {
  const json value = body.value("parameters", json::object());
  if (!value.is_object()) throw ApiError(400, "parameters must be an object");
  std::map<std::string, std::string> parameters;
  for (const auto& [name, text] : value.items()) {
    if (!text.is_string())
      throw ApiError(400, "parameters." + name + " must be a text, as after -p on the command line");
    if (name.size() + text.get_ref<const std::string&>().size() > longest_text)
      throw ApiError(400, "parameters." + name + " is longer than 1000 bytes");
    parameters[name] = text;
  }
  return parameters;
}

std::uint32_t frame_number(const json& value, const char* name, std::uint32_t otherwise) {
  const json number = value.value(name, json(otherwise));
  if (!number.is_number_unsigned() || number.get<std::uint64_t>() > UINT32_MAX)
    throw ApiError(400, std::string(name) + " must be a whole number, 0 or more");
  return number.get<std::uint32_t>();
}

/// {first, last, step}: the step may be left out.
std::optional<FrameRange> frames_in(const json& body) {
  if (!body.contains("frames")) return std::nullopt;
  const json& value = body["frames"];
  if (!value.is_object() || !value.contains("first") || !value.contains("last"))
    throw ApiError(400, "frames must be an object with first and last, and step");
  for (const auto& [name, ignored] : value.items())
    if (name != "first" && name != "last" && name != "step")
      throw ApiError(400, "frames." + name + " is unknown");
  return frame_range(frame_number(value, "first", 0), frame_number(value, "last", 0),
                     frame_number(value, "step", 1));
}

}  // namespace

json parse_json(const std::string& text) {
  int values = 0;
  const auto bounded = [&](int depth, json::parse_event_t event, json&) {
    const bool one_more = event == json::parse_event_t::value || event == json::parse_event_t::object_start ||
                          event == json::parse_event_t::array_start;
    if (depth > deepest || (one_more && ++values > most_values)) throw ApiError(400, "the JSON is too large");
    return true;
  };
  try {
    json value = json::parse(text, bounded);
    if (!value.is_object()) throw ApiError(400, "the body must be a JSON object");
    return value;
  } catch (const json::exception& error) {
    throw ApiError(400, error.what());
  }
}

int priority_from_json(const json& value) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > 99)
    throw ApiError(400, "priority must be a whole number, 0 to 99");
  return value.get<int>();
}

JobSpec job_wishes(const json& body) {
  constexpr std::array known{"scene",       "assets",     "scene_name", "scene_of", "script",
                             "script_name", "parameters", "frames",     "name",     "output",
                             "priority",    "hold",       "key",        "settings", "verify"};
  for (const auto& [name, ignored] : body.items())
    if (std::find(known.begin(), known.end(), name) == known.end()) throw ApiError(400, name + " is unknown");

  JobSpec spec;
  spec.name = text_in(body, "name");
  spec.output = text_in(body, "output");
  spec.key = text_in(body, "key");
  spec.hold = flag_in(body, "hold");
  if (body.contains("priority")) spec.priority = priority_from_json(body["priority"]);
  if (body.contains("verify")) spec.verification = parse_verification(text_in(body, "verify"));
  spec.parameters = parameters_in(body);
  spec.frames = frames_in(body);
  return spec;
}

std::vector<AssetData> assets_in(const json& body, AssetStore& store) {
  const json value = body.value("assets", json::array());
  if (!value.is_array()) throw ApiError(400, "assets must be a list of hashes");
  std::vector<AssetData> assets;
  for (const json& hash : value) {
    if (!hash.is_string()) throw ApiError(400, "assets must be a list of hashes");
    const std::optional<AssetData> asset = store.find(hash.get_ref<const std::string&>());
    if (!asset)
      throw ApiError(409, "the asset " + hash.get<std::string>().substr(0, 64) +
                              " is not here: upload it first by POST /api/v1/assets");
    assets.push_back(*asset);
  }
  return assets;
}

SceneData scene_in(const json& body, std::span<const AssetData> assets) {
  if (!body.contains("scene") || !body["scene"].is_string())
    throw ApiError(400, "scene must be there: the encoded scene in base64");
  Bytes bytes = from_base64(body["scene"].get_ref<const std::string&>());
  std::vector<Asset> decoded;
  for (const AssetData& asset : assets) decoded.push_back(decode_asset(asset));
  decode_scene(bytes, decoded);  // throws unless it can be rendered; workers decode it again
  const std::string hash = sha256_hex(bytes);
  return {hash, std::make_shared<const Bytes>(std::move(bytes))};
}

JobSpec job_spec(const json& body, AssetStore& store) {
  JobSpec spec = job_wishes(body);
  spec.settings = settings_from_json(body.value("settings", json::object()));
  spec.assets = assets_in(body, store);
  SceneData scene = scene_in(body, spec.assets);
  spec.scene_hash = std::move(scene.hash);
  spec.scene_bytes = std::move(scene.bytes);
  return spec;
}

SubmittedFrame frame_from_json(const json& body, AssetStore& store) {
  for (const auto& [name, ignored] : body.items())
    if (name != "frame" && name != "scene" && name != "assets") throw ApiError(400, name + " is unknown");
  if (!body.contains("frame")) throw ApiError(400, "frame must be there: the frame's number");
  std::vector<AssetData> assets = assets_in(body, store);
  SceneData scene = scene_in(body, assets);
  return {frame_number(body, "frame", 0), std::move(scene), std::move(assets)};
}

namespace {

json hashes_of(const std::vector<AssetData>& assets) {
  json hashes = json::array();
  for (const AssetData& asset : assets) hashes.push_back(asset.hash);
  return hashes;
}

}  // namespace

json to_json(const SubmittedFrame& frame) {
  return {
      {"frame", frame.number}, {"scene", base64(*frame.scene.bytes)}, {"assets", hashes_of(frame.assets)}};
}

json to_json(const JobSpec& spec) {
  json object = {{"scene", base64(*spec.scene_bytes)},
                 {"assets", hashes_of(spec.assets)},
                 {"name", spec.name},
                 {"output", spec.output},
                 {"priority", spec.priority},
                 {"hold", spec.hold},
                 {"key", spec.key},
                 {"verify", text_of(spec.verification)},
                 {"parameters", spec.parameters},
                 {"settings", to_json(spec.settings)}};
  if (const auto& frames = spec.frames)
    object["frames"] = {{"first", frames->first}, {"last", frames->last}, {"step", frames->step}};
  return object;
}

}  // namespace rayfarm
