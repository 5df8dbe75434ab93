// What a script makes of files and of lists of points: meshes, Bezier surfaces, image textures.
#pragma once
#include <lua.h>

#include <vector>

#include "master/script/lua_values.h"

namespace rayfarm {

/// Makes mesh{} bezier{} picture{} known to scripts.
void open_assets(lua_State* L);

const std::vector<Signature>& asset_signatures();

}  // namespace rayfarm
