#include "master/script/exchange.h"

#include <nlohmann/json.hpp>

#include "common/net/codec.h"

namespace rayfarm {
namespace {

using nlohmann::json;

std::string cbor(const json& value) {
  std::string bytes;
  json::to_cbor(value, bytes);
  return bytes;
}

json to_json(const ScriptParameter& p) {
  json value = {{"name", p.name},
                {"type", p.type},
                {"default", p.default_value},
                {"help", p.help},
                {"choices", p.choices}};
  if (p.min) value["min"] = *p.min;
  if (p.max) value["max"] = *p.max;
  return value;
}

ScriptParameter parameter_from(const json& value) {
  ScriptParameter p{
      value.at("name"), value.at("type"), value.at("default"), value.at("help"), value.at("choices"), {}, {}};
  if (value.contains("min")) p.min = value.at("min").get<double>();
  if (value.contains("max")) p.max = value.at("max").get<double>();
  return p;
}

}  // namespace

std::string encode_task(const ScriptTask& task) {
  return cbor({{"name", task.request.name},
               {"text", task.request.text},
               {"params", task.request.params},
               {"frame", task.request.frame},
               {"cpu_seconds", task.limits.cpu_seconds},
               {"memory_bytes", task.limits.memory_bytes}});
}

ScriptTask decode_task(std::string_view bytes) {
  const json value = json::from_cbor(bytes);
  ScriptTask task;
  task.request = {value.at("name"), value.at("text"), value.at("params"), value.at("frame")};
  task.limits.cpu_seconds = value.at("cpu_seconds");
  task.limits.memory_bytes = value.at("memory_bytes");
  return task;
}

std::string encode_reply(const ScriptResult& result) {
  json parameters = json::array();
  for (const ScriptParameter& p : result.parameters) parameters.push_back(to_json(p));
  return cbor({{"scene", json::binary(encode_scene(result.scene))}, {"parameters", parameters}});
}

std::string encode_error(std::string_view message) { return cbor({{"error", message}}); }

ScriptResult decode_reply(std::string_view bytes) {
  const json value = json::from_cbor(bytes);
  if (value.contains("error")) throw SceneError(value.at("error").get<std::string>());
  ScriptResult result;
  result.scene = decode_scene(value.at("scene").get_binary());
  for (const json& parameter : value.at("parameters")) result.parameters.push_back(parameter_from(parameter));
  return result;
}

}  // namespace rayfarm
