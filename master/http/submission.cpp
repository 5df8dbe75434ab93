#include "master/http/submission.h"

#include <array>
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
  constexpr std::array known{"scene", "scene_name", "scene_of", "script", "script_name", "parameters",
                             "name",  "output",     "priority", "hold",   "key",         "settings"};
  for (const auto& [name, ignored] : body.items())
    if (std::find(known.begin(), known.end(), name) == known.end()) throw ApiError(400, name + " is unknown");

  JobSpec spec;
  spec.name = text_in(body, "name");
  spec.output = text_in(body, "output");
  spec.key = text_in(body, "key");
  spec.hold = flag_in(body, "hold");
  if (body.contains("priority")) spec.priority = priority_from_json(body["priority"]);
  spec.parameters = parameters_in(body);
  return spec;
}

JobSpec job_spec(const json& body) {
  if (!body.contains("scene") || !body["scene"].is_string())
    throw ApiError(400, "scene must be there: the encoded scene in base64");

  JobSpec spec = job_wishes(body);
  spec.settings = settings_from_json(body.value("settings", json::object()));
  Bytes bytes = from_base64(body["scene"].get_ref<const std::string&>());
  decode_scene(bytes);  // throws unless it can be rendered; workers decode it again
  spec.scene_hash = sha256_hex(bytes);
  spec.scene_bytes = std::make_shared<const Bytes>(std::move(bytes));
  return spec;
}

json to_json(const JobSpec& spec) {
  return {{"scene", base64(*spec.scene_bytes)},
          {"name", spec.name},
          {"output", spec.output},
          {"priority", spec.priority},
          {"hold", spec.hold},
          {"key", spec.key},
          {"parameters", spec.parameters},
          {"settings", to_json(spec.settings)}};
}

}  // namespace rayfarm
