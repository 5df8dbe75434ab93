#include "master/script/exchange.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/net/codec.h"

namespace rayfarm {
namespace {

using nlohmann::json;

/// Bytes that are no UTF-8 (only messages and parameters may have such) are replaced.
std::string message(const json& head, std::string_view body) {
  std::string bytes = head.dump(-1, ' ', false, json::error_handler_t::replace);
  bytes += '\n';
  return bytes.append(body);
}

struct Message {
  json head;
  std::string_view body;
};

Message split(std::string_view bytes) {
  constexpr std::size_t longest_head = 4 << 20;  // JSON takes many times its length in memory
  const std::size_t end = bytes.substr(0, longest_head).find('\n');
  if (end == std::string_view::npos) throw std::runtime_error("its first line does not end");
  return {json::parse(bytes.substr(0, end)), bytes.substr(end + 1)};
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
  json head = {{"name", task.request.name},
               {"params", task.request.params},
               {"frame", task.request.frame},
               {"cpu_seconds", task.limits.cpu_seconds},
               {"memory_bytes", task.limits.memory_bytes}};
  if (const auto& animation = task.request.animation)
    head["animation"] = {animation->start, animation->stop, animation->fps};
  return message(head, task.request.text);
}

ScriptTask decode_task(std::string_view bytes) {
  const auto [head, text] = split(bytes);
  ScriptTask task;
  task.request = {head.at("name"), std::string(text), head.at("params"), head.at("frame"), {}};
  if (head.contains("animation")) {
    const json& animation = head.at("animation");
    task.request.animation = Animation{animation.at(0), animation.at(1), animation.at(2)};
  }
  task.limits.cpu_seconds = head.at("cpu_seconds");
  task.limits.memory_bytes = head.at("memory_bytes");
  return task;
}

std::string encode_reply(const ScriptResult& result) {
  json parameters = json::array();
  for (const ScriptParameter& p : result.parameters) parameters.push_back(to_json(p));
  const Bytes scene = encode_scene(result.scene);
  return message({{"parameters", parameters}}, {reinterpret_cast<const char*>(scene.data()), scene.size()});
}

std::string encode_error(std::string_view text) { return message({{"error", text}}, {}); }

ScriptResult decode_reply(std::string_view bytes) {
  const auto [head, scene] = split(bytes);
  if (head.contains("error")) throw SceneError(head.at("error").get<std::string>());
  ScriptResult result;
  result.scene = decode_scene({reinterpret_cast<const std::uint8_t*>(scene.data()), scene.size()});
  for (const json& parameter : head.at("parameters")) result.parameters.push_back(parameter_from(parameter));
  return result;
}

}  // namespace rayfarm
