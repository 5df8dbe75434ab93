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
  json files = json::array();
  std::string body = task.request.text;
  for (const auto& [name, bytes] : task.files) {
    files.push_back({name, bytes.size()});
    body += bytes;
  }
  json head = {{"name", task.request.name},
               {"text_bytes", task.request.text.size()},
               {"files", std::move(files)},
               {"params", task.request.params},
               {"frame", task.request.frame},
               {"cpu_seconds", task.limits.cpu_seconds},
               {"memory_bytes", task.limits.memory_bytes}};
  if (const auto& animation = task.request.animation)
    head["animation"] = {animation->start, animation->stop, animation->fps};
  return message(head, body);
}

ScriptTask decode_task(std::string_view bytes) {
  auto [head, body] = split(bytes);
  const auto next = [&body = body](std::size_t size) {
    const std::string_view part = body.substr(0, size);
    body.remove_prefix(part.size());
    return part;
  };
  ScriptTask task;
  task.request.name = head.at("name"), task.request.text = next(head.at("text_bytes"));
  task.request.params = head.at("params"), task.request.frame = head.at("frame");
  for (const json& file : head.at("files"))
    task.files.emplace(file.at(0).get<std::string>(), next(file.at(1)));
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
  std::string body(scene.begin(), scene.end());
  json assets = json::array();
  for (const AssetData& asset : result.assets) {
    assets.push_back({asset.hash, asset.bytes->size()});
    body.append(asset.bytes->begin(), asset.bytes->end());
  }
  return message({{"parameters", parameters}, {"scene_bytes", scene.size()}, {"assets", std::move(assets)}},
                 body);
}

std::string encode_error(std::string_view text) { return message({{"error", text}}, {}); }

std::string encode_wish(const std::vector<std::string>& files) { return message({{"files", files}}, {}); }

namespace {

/// Takes the next part of a body.
ByteView next_part(std::string_view& body, const json& bytes) {
  if (!bytes.is_number_unsigned()) throw std::runtime_error("a size must be a whole number");
  const std::size_t size = bytes;
  if (size > body.size()) throw std::runtime_error("it ends too early");
  const ByteView part{reinterpret_cast<const std::uint8_t*>(body.data()), size};
  body.remove_prefix(size);
  return part;
}

}  // namespace

ScriptReply decode_reply(std::string_view bytes) {
  auto [head, body] = split(bytes);
  if (head.contains("error")) throw SceneError(head.at("error").get<std::string>());
  if (head.contains("files")) return head.at("files").get<std::vector<std::string>>();
  ScriptResult result;
  const ByteView scene = next_part(body, head.at("scene_bytes"));
  std::vector<Asset> assets;
  for (const json& asset : head.at("assets")) {
    const ByteView part = next_part(body, asset.at(1));
    result.assets.push_back({asset.at(0), std::make_shared<const Bytes>(part.begin(), part.end())});
    assets.push_back(decode_asset(result.assets.back()));
  }
  result.scene = decode_scene(scene, assets);
  for (const json& parameter : head.at("parameters")) result.parameters.push_back(parameter_from(parameter));
  return result;
}

}  // namespace rayfarm
