// param{ "depth", type = "int", default = 5, ... } for scripts: what -p key=value may set.
#pragma once
#include <lua.h>

#include "master/script/lua_values.h"
#include "master/script/script_run.h"

namespace rayfarm {

void open_params(lua_State* L);
/// Throws SceneError when the user gave a parameter that the script has not declared.
void check_all_declared(const ScriptRun& run);

const Signature& param_signature();

}  // namespace rayfarm
