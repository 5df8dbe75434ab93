// The standard functions that a script may use: Lua's own, without those that reach outside the script, and
// with those that differ from run to run or from CPU to CPU replaced.
#pragma once
#include <lua.h>

#include <string>
#include <vector>

namespace rayfarm {

/// Opens the libraries in an empty state.
void open_library(lua_State* L);
/// Replaces pairs, next and table.sort by versions whose order is always the same.
void open_ordered(lua_State* L);
/// From now on a global name that is not there is an error, with the nearest one that is.
void make_globals_strict(lua_State* L);

/// Lua's functions that are not there, "os" or "string.dump".
const std::vector<std::string>& removed_names();

}  // namespace rayfarm
