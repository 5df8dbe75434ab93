// One evaluation of a script: what its functions need to know, and what they leave behind.
#pragma once
#include <lua.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/scene/scene.h"
#include "master/script/assets.h"
#include "master/script/exchange.h"

namespace rayfarm {

struct ScriptRun {
  const std::map<std::string, std::string>& params;  // as the user gave them
  const ScriptFiles& files;                          // that the script was given
  std::set<std::string> missing_files{};             // that it also asks for
  Assets assets{};                                   // of its scene
  std::vector<ScriptParameter> parameters{};         // as the script declared them
  std::optional<Scene> scene{};                      // once scene{} was called
};

/// The run that the state evaluates; known to all its coroutines.
inline ScriptRun& run_of(lua_State* L) { return **static_cast<ScriptRun**>(lua_getextraspace(L)); }
inline void set_run(lua_State* L, ScriptRun& run) { *static_cast<ScriptRun**>(lua_getextraspace(L)) = &run; }

}  // namespace rayfarm
