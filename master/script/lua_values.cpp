#include "master/script/lua_values.h"

#include <algorithm>
#include <cmath>

#include "master/script/suggestion.h"

namespace rayfarm {
namespace {

/// Three numbers of the table at the index.
glm::dvec3 triple_at(lua_State* L, int index, const std::string& what, const char* form, Range range) {
  index = lua_absindex(L, index);
  if (lua_type(L, index) != LUA_TTABLE)
    throw SceneError(what + " must be " + form + ", is " + description(L, index));
  if (lua_rawlen(L, index) != 3)
    throw SceneError(what + " must be " + form + ", has " + std::to_string(lua_rawlen(L, index)) +
                     " numbers");
  glm::dvec3 v;
  for (int i = 0; i < 3; ++i) {
    lua_rawgeti(L, index, i + 1);
    v[i] = number_at(L, -1, what, range);
    lua_pop(L, 1);
  }
  return v;
}

}  // namespace

std::string text_of(double x) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.14g", std::isnan(x) ? std::fabs(x) : x);
  return buffer;
}

void push_error(lua_State* L, std::string_view message) {
  luaL_where(L, 1);
  lua_pushlstring(L, message.data(), message.size());
  lua_concat(L, 2);
}

std::string description(lua_State* L, int index) {
  switch (lua_type(L, index)) {
    case LUA_TNONE:
    case LUA_TNIL:
      return "nil";
    case LUA_TBOOLEAN:
      return lua_toboolean(L, index) ? "true" : "false";
    case LUA_TNUMBER:
      return "the number " + text_of(lua_tonumber(L, index));
    case LUA_TSTRING: {
      std::string s = lua_tostring(L, index);
      if (s.size() > 40) s = s.substr(0, 40) + "...";
      return "the string '" + s + "'";
    }
    case LUA_TUSERDATA:
      if (luaL_getmetafield(L, index, "__name") == LUA_TSTRING) {
        const std::string name = lua_tostring(L, -1);
        lua_pop(L, 1);
        return "a " + name;
      }
  }
  return std::string("a ") + luaL_typename(L, index);
}

double number_at(lua_State* L, int index, const std::string& what, Range range) {
  // A string that looks like a number is none: "10" is a mistake that should be seen.
  if (lua_type(L, index) != LUA_TNUMBER)
    throw SceneError(what + " must be a number, is " + description(L, index));
  const double x = lua_tonumber(L, index);
  if (std::isnan(x) || (range != Range::infinite_too && !std::isfinite(x)))
    throw SceneError(what + " must be a finite number, is " + text_of(x));
  if (range == Range::positive && !(x > 0)) throw SceneError(what + " must be positive, is " + text_of(x));
  if (range == Range::not_negative && x < 0)
    throw SceneError(what + " must not be negative, is " + text_of(x));
  return x;
}

glm::dvec3 vector_at(lua_State* L, int index, const std::string& what, Range range) {
  return triple_at(L, index, what, "{x, y, z}", range);
}

glm::dvec3 color_at(lua_State* L, int index, const std::string& what) {
  if (lua_type(L, index) == LUA_TNUMBER) return glm::dvec3(number_at(L, index, what, Range::not_negative));
  return triple_at(L, index, what, "{r, g, b} or a number", Range::not_negative);
}

// Fields. ---------------------------------------------------------------------------------------------------

Fields::Fields(lua_State* L, int index, const Signature& signature)
    : L_(L), index_(lua_absindex(L, index)), signature_(signature) {
  if (lua_type(L, index_) != LUA_TTABLE) {
    const std::string name(signature.function);
    throw SceneError(name + ": expects a table, write " + name + "{ ... }; got " + description(L, index_));
  }
  check_keys();
}

void Fields::check_keys() const {
  for (lua_pushnil(L_); lua_next(L_, index_) != 0; lua_pop(L_, 1)) {
    if (lua_isinteger(L_, -2)) {
      const lua_Integer position = lua_tointeger(L_, -2);
      if (position >= 1 && position <= static_cast<lua_Integer>(signature_.by_position)) continue;
      throw SceneError(std::string(signature_.function) + ": value number " + std::to_string(position) +
                       " has no meaning here, give it a key");
    }
    if (lua_type(L_, -2) != LUA_TSTRING)
      throw SceneError(std::string(signature_.function) + ": a key must be a name, is " +
                       description(L_, -2));
    const std::string key = lua_tostring(L_, -2);
    if (std::find(signature_.keys.begin(), signature_.keys.end(), key) != signature_.keys.end()) continue;
    const std::vector<std::string> known(signature_.keys.begin(), signature_.keys.end());
    std::string hint = suggestion(key, known);
    if (hint.empty() && known.empty()) hint = ", there are none";
    if (hint.empty()) {
      hint = ", there are:";
      for (const std::string& k : known) hint += " " + k;
    }
    throw SceneError(std::string(signature_.function) + ": unknown key '" + key.substr(0, 40) + "'" + hint);
  }
}

std::string Fields::place(std::string_view key) const {
  return std::string(signature_.function) + ": " + std::string(key);
}

bool Fields::push(std::string_view key) const {
  lua_pushlstring(L_, key.data(), key.size());
  const bool named = lua_rawget(L_, index_) != LUA_TNIL;
  if (!named) lua_pop(L_, 1);
  const auto position =
      std::find(signature_.keys.begin(), signature_.keys.end(), key) - signature_.keys.begin();
  if (position >= static_cast<std::ptrdiff_t>(signature_.by_position)) return named;

  if (lua_rawgeti(L_, index_, position + 1) == LUA_TNIL) {
    lua_pop(L_, 1);
    return named;
  }
  if (named) throw SceneError(place(key) + " is given twice, by name and by position");
  return true;
}

double Fields::number(std::string_view key, double otherwise, Range range) const {
  if (!push(key)) return otherwise;
  const double x = number_at(L_, -1, place(key), range);
  lua_pop(L_, 1);
  return x;
}

std::uint32_t Fields::integer(std::string_view key, std::uint32_t otherwise, std::uint32_t least,
                              std::uint32_t most) const {
  const double x = number(key, otherwise);
  if (x != std::floor(x)) throw SceneError(place(key) + " must be a whole number, is " + text_of(x));
  if (x < least)
    throw SceneError(place(key) + " must be at least " + std::to_string(least) + ", is " + text_of(x));
  if (x > most)
    throw SceneError(place(key) + " must be at most " + std::to_string(most) + ", is " + text_of(x));
  return static_cast<std::uint32_t>(x);
}

glm::dvec3 Fields::vector(std::string_view key, const glm::dvec3& otherwise, Range range) const {
  if (!push(key)) return otherwise;
  const glm::dvec3 v = vector_at(L_, -1, place(key), range);
  lua_pop(L_, 1);
  return v;
}

glm::dvec3 Fields::color(std::string_view key, const glm::dvec3& otherwise) const {
  if (!push(key)) return otherwise;
  const glm::dvec3 c = color_at(L_, -1, place(key));
  lua_pop(L_, 1);
  return c;
}

bool Fields::boolean(std::string_view key, bool otherwise) const {
  if (!push(key)) return otherwise;
  if (!lua_isboolean(L_, -1))
    throw SceneError(place(key) + " must be true or false, is " + description(L_, -1));
  const bool value = lua_toboolean(L_, -1) != 0;
  lua_pop(L_, 1);
  return value;
}

std::optional<std::string> Fields::text(std::string_view key) const {
  if (!push(key)) return std::nullopt;
  if (lua_type(L_, -1) != LUA_TSTRING)
    throw SceneError(place(key) + " must be a string, is " + description(L_, -1));
  std::string s = lua_tostring(L_, -1);
  lua_pop(L_, 1);
  return s;
}

bool Fields::has(std::string_view key) const {
  if (!push(key)) return false;
  lua_pop(L_, 1);
  return true;
}

void Fields::require(std::string_view key) const {
  if (!has(key)) throw SceneError(place(key) + " is missing");
}

}  // namespace rayfarm
