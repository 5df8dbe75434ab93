#include "master/http/script_submission.h"

#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "common/net/text.h"
#include "master/http/settings_json.h"
#include "master/script/animation.h"

namespace rayfarm {
namespace {

using nlohmann::json;

struct NamedScript {
  std::string name, text;          // "circus.lua"
  std::filesystem::path folder{};  // of the files that it may name; empty: none
};

std::string text_member(const json& body, const char* name) {
  if (!body.at(name).is_string()) throw ApiError(400, std::string(name) + " must be a text");
  return body.at(name);
}

NamedScript uploaded(const json& body, const char* name_member) {
  NamedScript script{"script.lua", text_member(body, "script")};
  if (body.contains(name_member)) script.name = text_member(body, name_member);
  if (script.text.size() > longest_script) throw ApiError(413, "a script may have at most 1 MB");
  if (script.name.empty() || script.name.size() > 200 || !is_plain_text(script.name))
    throw ApiError(422, std::string(name_member) + " must be one line of text, of 1 to 200 bytes");
  return script;
}

NamedScript chosen_script(const json& body, const SceneLibrary& library) {
  if (body.contains("script")) return uploaded(body, "script_name");
  const std::string name = text_member(body, "scene_name");
  return {name + ".lua", library.script(name), library.folder()};
}

/// What is not given is as the scene wants it.
RenderSettings settings_for(const json& given, const ImageDefaults& image) {
  json all = json::object();
  if (image.width) all["width"] = *image.width;
  if (image.height) all["height"] = *image.height;
  if (image.spp) all["spp"] = *image.spp;
  all.update(given);
  RenderSettings settings = settings_from_json(all);
  leave_out(settings, image);
  return settings;
}

json to_json(const ScriptParameter& p) {
  return {{"name", p.name},
          {"type", p.type},
          {"default", p.default_value},
          {"help", p.help},
          {"choices", p.choices},
          {"min", p.min ? json(*p.min) : json()},
          {"max", p.max ? json(*p.max) : json()}};
}

json to_json(const std::optional<std::uint32_t>& number) { return number ? json(*number) : json(); }

}  // namespace

ScriptFacts script_facts(const json& body, const HasLeft& has_left) {
  for (const auto& [name, ignored] : body.items())
    if (name != "script" && name != "name") throw ApiError(400, name + " is unknown");
  if (!body.contains("script")) throw ApiError(400, "script must be there: the text of the script");
  NamedScript script = uploaded(body, "name");
  ScriptResult result =
      evaluate({std::move(script.name), std::move(script.text), {}, 0}, look_limits, has_left);
  return {std::move(result.parameters), result.scene.image, result.scene.animation};
}

json to_json(const ScriptFacts& facts) {
  json parameters = json::array();
  for (const ScriptParameter& parameter : facts.parameters) parameters.push_back(to_json(parameter));
  const auto& animation = facts.animation;
  return {{"parameters", std::move(parameters)},
          {"image",
           {{"width", to_json(facts.image.width)},
            {"height", to_json(facts.image.height)},
            {"spp", to_json(facts.image.spp)}}},
          {"animation",
           animation ? json{{"start", animation->start}, {"stop", animation->stop}, {"fps", animation->fps}}
                     : json()}};
}

json to_json(const OfferedScene& scene) {
  json object = to_json(scene.facts);
  object["name"] = scene.name, object["title"] = scene.title, object["script"] = scene.script;
  if (!scene.error.empty()) object["error"] = scene.error;
  return object;
}

SubmittedJob submitted_job(const json& body, const SceneLibrary& library, AssetStore& store,
                           const HasLeft& has_left) {
  const auto sources = body.contains("scene") + body.contains("scene_name") + body.contains("script");
  if (sources != 1) throw ApiError(400, "one of scene, scene_name and script must be there");
  if (body.contains("scene")) return {job_spec(body, store), {}};

  JobSpec spec = job_wishes(body);
  const json settings = body.value("settings", json::object());
  spec.settings = settings_from_json(settings);  // a mistake in them is told before the script runs
  NamedScript chosen = chosen_script(body, library);
  const std::string name = chosen.name;
  if (spec.name.empty()) spec.name = name.ends_with(".lua") ? name.substr(0, name.size() - 4) : name;
  const std::uint32_t first = spec.frames ? spec.frames->first : spec.settings.frame;
  ScriptRequest script{std::move(chosen.name),  std::move(chosen.text), spec.parameters, first, {},
                       std::move(chosen.folder)};
  ScriptResult result = evaluate(script, {}, has_left);
  const Scene& scene = result.scene;
  if (spec.frames) expect_frames(script.name, scene, *spec.frames);
  script.animation = scene.animation;
  spec.settings = settings_for(settings, scene.image);
  Bytes bytes = encode_scene(scene);
  spec.scene_hash = sha256_hex(bytes);
  spec.scene_bytes = std::make_shared<const Bytes>(std::move(bytes));
  for (AssetData& asset : result.assets) spec.assets.push_back(store.add(std::move(asset)));
  return {std::move(spec), std::move(script)};
}

}  // namespace rayfarm
