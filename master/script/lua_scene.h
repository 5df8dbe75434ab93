// What surrounds the tree, for scripts: materials, textures, cameras, lights and scene{} itself.
#pragma once
#include <lua.h>

#include <vector>

#include "master/script/lua_values.h"

namespace rayfarm {

void open_scene(lua_State* L);

/// What open_scene() makes known; those of image = {} and animation = {} too.
const std::vector<Signature>& scene_signatures();

/// The userdata that scene{} answers with: a mark, the scene itself is in the ScriptRun.
struct SceneMark {};
template <>
struct LuaName<SceneMark> {
  static constexpr const char* value = "scene";
};

}  // namespace rayfarm
