#include "master/script/lua_params.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "master/script/suggestion.h"

namespace rayfarm {
namespace {

bool contains(const std::vector<std::string>& list, const std::string& s) {
  return std::find(list.begin(), list.end(), s) != list.end();
}

std::string joined(const std::vector<std::string>& list) {
  std::string all;
  for (const std::string& s : list) all += (all.empty() ? "" : ", ") + s;
  return all;
}

/// The whole text as a number, or nothing.
template <class T>
std::optional<T> parsed(const std::string& text) {
  T x{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, x);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return x;
}

// Declaration. ----------------------------------------------------------------------------------------------

std::vector<std::string> read_choices(lua_State* L, const Fields& fields) {
  std::vector<std::string> choices;
  if (!fields.push("choices")) return choices;
  if (lua_type(L, -1) != LUA_TTABLE || lua_rawlen(L, -1) == 0)
    throw SceneError(fields.place("choices") + " must be a list of strings, is " + description(L, -1));
  for (lua_Unsigned i = 1, n = lua_rawlen(L, -1); i <= n; ++i, lua_pop(L, 1)) {
    lua_rawgeti(L, -1, static_cast<lua_Integer>(i));
    if (lua_type(L, -1) != LUA_TSTRING)
      throw SceneError(fields.place("choices") + " must be strings, one is " + description(L, -1));
    choices.push_back(lua_tostring(L, -1));
  }
  lua_pop(L, 1);
  return choices;
}

/// The type of the default when the script names none.
std::string implied_type(lua_State* L, const std::vector<std::string>& choices, int index) {
  if (!choices.empty()) return "choice";
  if (lua_isinteger(L, index)) return "int";
  if (lua_type(L, index) == LUA_TNUMBER) return "number";
  if (lua_type(L, index) == LUA_TBOOLEAN) return "boolean";
  return "string";
}

bool fits(lua_State* L, int index, const std::string& type) {
  if (type == "int") return lua_isinteger(L, index);
  if (type == "number") return lua_type(L, index) == LUA_TNUMBER && std::isfinite(lua_tonumber(L, index));
  if (type == "boolean") return lua_isboolean(L, index);
  return lua_type(L, index) == LUA_TSTRING;
}

// Value. ----------------------------------------------------------------------------------------------------

/// Pushes the user's text as a value of the parameter's type.
void push_parsed(lua_State* L, const ScriptParameter& p, const std::string& text) {
  const auto refuse = [&](const char* wanted) {
    throw SceneError("parameter " + p.name + " must be " + wanted + ", is '" + text.substr(0, 40) + "'");
  };
  if (p.type == "int") {
    const auto x = parsed<lua_Integer>(text);
    if (!x) refuse("a whole number");
    lua_pushinteger(L, *x);
  } else if (p.type == "number") {
    const auto x = parsed<double>(text);
    if (!x || !std::isfinite(*x)) refuse("a number");
    lua_pushnumber(L, *x);
  } else if (p.type == "boolean") {
    if (text != "true" && text != "false") refuse("true or false");
    lua_pushboolean(L, text == "true");
  } else {
    lua_pushlstring(L, text.data(), text.size());
  }
}

/// Throws unless the value at the index is within the parameter's limits.
void check_limits(lua_State* L, const ScriptParameter& p, int index) {
  const std::string place = "parameter " + p.name;
  if (p.type == "choice" && !contains(p.choices, lua_tostring(L, index)))
    throw SceneError(place + " must be one of " + joined(p.choices) + ", is '" + lua_tostring(L, index) +
                     "'" + suggestion(lua_tostring(L, index), p.choices));
  if (p.type != "int" && p.type != "number") return;
  const double x = lua_tonumber(L, index);
  if (p.min && x < *p.min)
    throw SceneError(place + " must be at least " + text_of(*p.min) + ", is " + text_of(x));
  if (p.max && x > *p.max)
    throw SceneError(place + " must be at most " + text_of(*p.max) + ", is " + text_of(x));
}

int param(lua_State* L) {
  const Fields fields(L, 1, param_signature());
  ScriptRun& run = run_of(L);
  ScriptParameter p;
  fields.require("name");
  p.name = *fields.text("name");
  for (const ScriptParameter& other : run.parameters)
    if (other.name == p.name) throw SceneError("param: " + p.name + " is declared twice");
  p.help = fields.text("help").value_or("");
  p.choices = read_choices(L, fields);
  if (fields.has("min")) p.min = fields.number("min", 0);
  if (fields.has("max")) p.max = fields.number("max", 0);

  fields.require("default");
  fields.push("default");
  const int value = lua_gettop(L);
  p.type = fields.text("type").value_or(implied_type(L, p.choices, value));
  static const std::vector<std::string> types{"int", "number", "string", "boolean", "choice"};
  if (!contains(types, p.type))
    throw SceneError("param: type must be one of " + joined(types) + ", is '" + p.type + "'" +
                     suggestion(p.type, types));
  if ((p.type == "choice") == p.choices.empty())
    throw SceneError("param: type choice and a list of choices go together");
  if (!fits(L, value, p.type))
    throw SceneError("param: the default of " + p.name + " must be of type " + p.type + ", is " +
                     description(L, value));
  check_limits(L, p, value);
  p.default_value = luaL_tolstring(L, value, nullptr);
  lua_pop(L, 1);

  if (const auto given = run.params.find(p.name); given != run.params.end()) {
    push_parsed(L, p, given->second);
    check_limits(L, p, -1);
  }
  run.parameters.push_back(std::move(p));
  return 1;
}

}  // namespace

void open_params(lua_State* L) { lua_register(L, "param", guarded<param>); }

void check_all_declared(const ScriptRun& run) {
  std::vector<std::string> declared;
  for (const ScriptParameter& p : run.parameters) declared.push_back(p.name);
  for (const auto& [name, value] : run.params) {
    if (contains(declared, name)) continue;
    throw SceneError("the script has no parameter '" + name + "'" + suggestion(name, declared) +
                     (declared.empty() ? "; it has none" : "; it has: " + joined(declared)));
  }
}

const Signature& param_signature() {
  static const Signature signature{"param", {"name", "type", "default", "min", "max", "choices", "help"}, 1};
  return signature;
}

}  // namespace rayfarm
