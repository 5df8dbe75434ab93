// pairs, next and table.sort with an order that is always the same. Lua's own follow addresses and the clock.
#include <lauxlib.h>

#include <algorithm>
#include <cstring>

#include "master/script/lua_library.h"
#include "master/script/lua_values.h"

namespace rayfarm {
namespace {

// Keys: numbers ascending, then strings by their bytes, then false and true. --------------------------------

int rank(int type) { return type == LUA_TNUMBER ? 0 : type == LUA_TSTRING ? 1 : 2; }

bool key_precedes(lua_State* L, int a, int b) {
  const int type_a = lua_type(L, a), type_b = lua_type(L, b);
  if (type_a != type_b) return rank(type_a) < rank(type_b);
  if (type_a == LUA_TNUMBER) return lua_compare(L, a, b, LUA_OPLT);
  if (type_a == LUA_TBOOLEAN) return lua_toboolean(L, a) < lua_toboolean(L, b);
  std::size_t length_a = 0, length_b = 0;
  const char* const s = lua_tolstring(L, a, &length_a);
  const char* const t = lua_tolstring(L, b, &length_b);
  const int order = std::memcmp(s, t, std::min(length_a, length_b));
  return order != 0 ? order < 0 : length_a < length_b;
}

void require_orderly_key(lua_State* L, int index, const char* function) {
  const int type = lua_type(L, index);
  if (type != LUA_TNUMBER && type != LUA_TSTRING && type != LUA_TBOOLEAN)
    throw SceneError(std::string(function) + ": the table has " + description(L, index) +
                     " as a key; only numbers, strings and booleans have an order");
}

/// Merge sort of list[1 .. n], the table at the top of the stack, by precedes(a, b), of stack indices.
/// Stable, and safe whatever a script's comparison answers.
template <class Precedes>
void sort_list(lua_State* L, int list, lua_Integer n, Precedes precedes) {
  lua_createtable(L, static_cast<int>(std::min<lua_Integer>(n, 1 << 30)), 0);
  int from = list, to = lua_gettop(L);
  for (lua_Integer width = 1; width < n; width *= 2, std::swap(from, to))
    for (lua_Integer low = 1; low <= n; low += 2 * width) {
      const lua_Integer middle = std::min(low + width, n + 1), high = std::min(low + 2 * width, n + 1);
      lua_Integer a = low, b = middle;
      for (lua_Integer i = low; i < high; ++i) {
        bool take_b = a == middle;
        if (a < middle && b < high) {
          lua_rawgeti(L, from, a);
          lua_rawgeti(L, from, b);
          take_b = precedes(lua_gettop(L), lua_gettop(L) - 1);
          lua_pop(L, 2);
        }
        lua_rawgeti(L, from, take_b ? b++ : a++);
        lua_rawseti(L, to, i);
      }
    }
  if (from != list)
    for (lua_Integer i = 1; i <= n; ++i) {
      lua_rawgeti(L, from, i);
      lua_rawseti(L, list, i);
    }
  lua_settop(L, list);
}

/// The iterator of pairs; upvalues: the table, its keys in order, how many were visited.
int next_of_pairs(lua_State* L) {
  lua_Integer i = lua_tointeger(L, lua_upvalueindex(3));
  for (;;) {
    if (lua_rawgeti(L, lua_upvalueindex(2), ++i) == LUA_TNIL) return 1;
    lua_pushvalue(L, -1);
    if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL) break;  // not set to nil meanwhile
    lua_pop(L, 2);
  }
  lua_pushinteger(L, i);
  lua_replace(L, lua_upvalueindex(3));
  return 2;
}

int pairs(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 1);
  lua_newtable(L);
  lua_Integer n = 0;
  for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
    require_orderly_key(L, -2, "pairs");
    lua_pushvalue(L, -2);
    lua_rawseti(L, 2, ++n);
  }
  sort_list(L, 2, n, [L](int a, int b) { return key_precedes(L, a, b); });
  lua_pushinteger(L, 0);
  lua_pushcclosure(L, next_of_pairs, 3);
  return 1;
}

/// The least key above the given one: slow for loops over large tables, right for `next(t) == nil`.
int next(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 2);
  const bool first = lua_isnil(L, 2);
  lua_pushnil(L);  // 3: the least so far
  for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
    require_orderly_key(L, -2, "next");
    const int key = lua_gettop(L) - 1;
    if (!first && !key_precedes(L, 2, key)) continue;
    if (!lua_isnil(L, 3) && !key_precedes(L, key, 3)) continue;
    lua_pushvalue(L, key);
    lua_replace(L, 3);
  }
  if (lua_isnil(L, 3)) return 1;
  lua_pushvalue(L, 3);
  lua_rawget(L, 1);
  return 2;
}

int sort(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  const lua_Integer n = static_cast<lua_Integer>(lua_rawlen(L, 1));
  const bool by_function = !lua_isnoneornil(L, 2);
  if (by_function) luaL_checktype(L, 2, LUA_TFUNCTION);
  lua_settop(L, 2);
  lua_newtable(L);
  for (lua_Integer i = 1; i <= n; ++i) {
    lua_rawgeti(L, 1, i);
    lua_rawseti(L, 3, i);
  }
  sort_list(L, 3, n, [&](int a, int b) {
    if (!by_function) return lua_compare(L, a, b, LUA_OPLT) != 0;
    lua_pushvalue(L, 2);
    lua_pushvalue(L, a);
    lua_pushvalue(L, b);
    lua_call(L, 2, 1);
    const bool precedes = lua_toboolean(L, -1);
    lua_pop(L, 1);
    return precedes;
  });
  for (lua_Integer i = 1; i <= n; ++i) {
    lua_rawgeti(L, 3, i);
    lua_rawseti(L, 1, i);
  }
  return 0;
}

}  // namespace

void open_ordered(lua_State* L) {
  lua_register(L, "pairs", guarded<pairs>);
  lua_register(L, "next", guarded<next>);
  lua_getglobal(L, "table");
  lua_pushcfunction(L, guarded<sort>);
  lua_setfield(L, -2, "sort");
  lua_pop(L, 1);
}

}  // namespace rayfarm
