// Short ways to evaluate a text in this process, for tests of the language.
#pragma once
#include <map>
#include <string>

#include "master/script/run_script.h"

namespace rayfarm {

using Params = std::map<std::string, std::string>;

inline ScriptResult run(const std::string& text, Params params = {}, std::uint32_t frame = 0) {
  return std::get<ScriptResult>(run_script({{"test.lua", text, std::move(params), frame}, {}, {}}));
}

/// What the script is refused with, or "" when it is not.
inline std::string complaint(const std::string& text, Params params = {}) {
  try {
    run(text, std::move(params));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

/// The tree of `return scene{ root = <root> }`, behind other lines.
inline Scene scene_with(const std::string& root, const std::string& before = "") {
  return run(before + "\nreturn scene{ root = " + root + " }").scene;
}

/// The number that a Lua expression has: passed out as the place of a light.
inline double number(const std::string& expression, const std::string& before = "") {
  const Scene scene = run(before + "\nlocal result = " + expression +
                          "\nreturn scene{ root = sphere{}, lights = { point{ at = {result, 0, 0} } } }")
                          .scene;
  return std::get<PointLight>(scene.lights[0]).at.x;
}

/// The text that a Lua expression has: passed out as a name.
inline std::string text(const std::string& expression, const std::string& before = "") {
  return scene_with("sphere{}:name(" + expression + ")", before).nodes[0].name;
}

}  // namespace rayfarm
