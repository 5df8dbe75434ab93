#include "master/script/lua_library.h"

#include <lualib.h>

#include <algorithm>
#include <cmath>

#include "common/math/deterministic.h"
#include "master/script/lua_values.h"
#include "master/script/suggestion.h"

// Lua's operator ^ calls pow. This definition stands before libm's for all that is linked with this file.
extern "C" double pow(double base, double exponent) noexcept {
  return rayfarm::deterministic::pow(base, exponent);
}

namespace rayfarm {
namespace {

/// Calls Lua's own function, the upvalue of the running one, with the same arguments. Its complaints get the
/// place of the script's call.
int call_original(lua_State* L) {
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  if (lua_pcall(L, lua_gettop(L) - 1, 1, 0) == LUA_OK) return 1;
  push_error(L, lua_tostring(L, -1));
  return lua_error(L);
}

// math: the same bits on every CPU. -------------------------------------------------------------------------

template <double (*f)(double)>
int unary(lua_State* L) {
  lua_pushnumber(L, f(luaL_checknumber(L, 1)));
  return 1;
}
int math_atan(lua_State* L) {
  lua_pushnumber(L, deterministic::atan2(luaL_checknumber(L, 1), luaL_optnumber(L, 2, 1)));
  return 1;
}
int math_log(lua_State* L) {
  const double x = luaL_checknumber(L, 1), base = luaL_optnumber(L, 2, 0);
  if (lua_isnoneornil(L, 2))
    lua_pushnumber(L, deterministic::log(x));
  else if (base == 2)
    lua_pushnumber(L, deterministic::log2(x));
  else if (base == 10)
    lua_pushnumber(L, deterministic::log10(x));
  else
    lua_pushnumber(L, deterministic::log(x) / deterministic::log(base));
  return 1;
}
/// Without a seed Lua takes the time.
int math_randomseed(lua_State* L) {
  luaL_checknumber(L, 1);
  call_original(L);
  return 0;
}

void open_math(lua_State* L) {
  const luaL_Reg functions[] = {{"sin", unary<deterministic::sin>},
                                {"cos", unary<deterministic::cos>},
                                {"tan", unary<deterministic::tan>},
                                {"asin", unary<deterministic::asin>},
                                {"acos", unary<deterministic::acos>},
                                {"exp", unary<deterministic::exp>},
                                {"atan", math_atan},
                                {"log", math_log},
                                {nullptr, nullptr}};
  lua_getglobal(L, "math");
  luaL_setfuncs(L, functions, 0);
  lua_getfield(L, -1, "randomseed");
  lua_pushcclosure(L, math_randomseed, 1);
  lua_pushvalue(L, -1);
  lua_setfield(L, -3, "randomseed");
  lua_pushinteger(L, 0);
  lua_call(L, 1, 0);  // every run draws the same numbers
  lua_pop(L, 1);
}

// Text: no addresses, which differ from run to run. ---------------------------------------------------------

/// tostring; a value without a text of its own is its type's name.
int to_string(lua_State* L) {
  luaL_checkany(L, 1);
  const int type = lua_type(L, 1);
  const bool has_address =
      type == LUA_TTABLE || type == LUA_TFUNCTION || type == LUA_TUSERDATA || type == LUA_TTHREAD;
  if (!has_address || luaL_getmetafield(L, 1, "__tostring") != LUA_TNIL) {
    lua_settop(L, 1);
    luaL_tolstring(L, 1, nullptr);
  } else if (type != LUA_TUSERDATA || luaL_getmetafield(L, 1, "__name") != LUA_TSTRING) {
    lua_pushstring(L, lua_typename(L, type));
  }
  return 1;
}

int format(lua_State* L) {
  const std::string_view form = luaL_checkstring(L, 1);
  for (std::size_t i = form.find('%'); i < form.size(); i = form.find('%', i + 1)) {
    i = std::min(form.find_first_not_of("-+ #0123456789.", i + 1), form.size());
    if (i < form.size() && form[i] == 'p')
      return luaL_error(L, "format: %%p is not available in a scene script");
  }
  for (int i = 2, n = lua_gettop(L); i <= n; ++i) {
    if (lua_type(L, i) < LUA_TTABLE) continue;
    lua_pushcfunction(L, to_string);
    lua_pushvalue(L, i);
    lua_call(L, 1, 1);
    lua_replace(L, i);
  }
  return call_original(L);
}

/// To the standard error stream, which the caller forwards; see script.h.
int print(lua_State* L) {
  std::string line;
  for (int i = 1, n = lua_gettop(L); i <= n; ++i) {
    lua_pushcfunction(L, to_string);
    lua_pushvalue(L, i);
    lua_call(L, 1, 1);
    if (i > 1) line += '\t';
    line += lua_tostring(L, -1);
    lua_pop(L, 1);
  }
  std::fprintf(stderr, "%s\n", line.c_str());
  return 0;
}

/// Lua's setmetatable, but for finalizers, which run where no limit reaches them.
int set_metatable(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  luaL_argexpected(L, lua_isnil(L, 2) || lua_istable(L, 2), 2, "nil or table");
  if (luaL_getmetafield(L, 1, "__metatable") != LUA_TNIL)
    return luaL_error(L, "cannot change a protected metatable");
  if (lua_istable(L, 2)) {
    lua_pushliteral(L, "__gc");
    if (lua_rawget(L, 2) != LUA_TNIL)
      return luaL_error(L, "setmetatable: __gc is not available in a scene script");
  }
  lua_settop(L, 2);
  lua_setmetatable(L, 1);
  return 1;
}

/// Replaces a function by one that has the original as its upvalue.
void wrap(lua_State* L, const char* table, const char* name, lua_CFunction wrapper) {
  lua_getglobal(L, table);
  lua_getfield(L, -1, name);
  lua_pushcclosure(L, wrapper, 1);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
}

void remove_unsafe(lua_State* L) {
  for (const std::string& name : removed_names()) {
    const std::size_t dot = name.find('.');
    lua_getglobal(L, dot == std::string::npos ? "_G" : name.substr(0, dot).c_str());
    lua_pushnil(L);
    lua_setfield(L, -2, dot == std::string::npos ? name.c_str() : name.c_str() + dot + 1);
    lua_pop(L, 1);
  }
}

// Globals. --------------------------------------------------------------------------------------------------

int unknown_global(lua_State* L) {
  const std::string name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : description(L, 2);
  const std::vector<std::string>& removed = removed_names();
  if (std::find(removed.begin(), removed.end(), name) != removed.end())
    throw SceneError("'" + name + "' is not available in a scene script");
  std::vector<std::string> known;
  for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1))
    if (lua_type(L, -2) == LUA_TSTRING) known.push_back(lua_tostring(L, -2));
  std::sort(known.begin(), known.end());
  throw SceneError("unknown name '" + name.substr(0, 40) + "'" + suggestion(name, known));
}

}  // namespace

void open_library(lua_State* L) {
  const luaL_Reg libraries[] = {{LUA_GNAME, luaopen_base},          {LUA_TABLIBNAME, luaopen_table},
                                {LUA_STRLIBNAME, luaopen_string},   {LUA_MATHLIBNAME, luaopen_math},
                                {LUA_COLIBNAME, luaopen_coroutine}, {LUA_UTF8LIBNAME, luaopen_utf8}};
  for (const luaL_Reg& library : libraries) {
    luaL_requiref(L, library.name, library.func, 1);
    lua_pop(L, 1);
  }
  remove_unsafe(L);
  open_math(L);
  open_ordered(L);
  lua_register(L, "tostring", to_string);
  lua_register(L, "print", print);
  lua_register(L, "setmetatable", set_metatable);
  wrap(L, "string", "format", format);
}

void make_globals_strict(lua_State* L) {
  lua_pushglobaltable(L);
  lua_createtable(L, 0, 2);
  lua_pushcfunction(L, guarded<unknown_global>);
  lua_setfield(L, -2, "__index");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
  lua_pop(L, 1);
}

const std::vector<std::string>& removed_names() {
  static const std::vector<std::string> names{"collectgarbage", "debug",    "dofile", "io",
                                              "load",           "loadfile", "os",     "package",
                                              "require",        "warn",     "xpcall", "string.dump"};
  return names;
}

}  // namespace rayfarm
