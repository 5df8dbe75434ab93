// The methods of nodes. Each gives a changed copy: nodes are values. First written, first applied.
#include <cmath>

#include "common/net/text.h"
#include "master/script/lua_nodes.h"
#include "master/script/node_value.h"
#include "master/script/suggestion.h"

namespace rayfarm {
namespace {

const NodeValue& self(lua_State* L, const std::string& method) {
  if (luaL_testudata(L, 1, LuaName<NodeValue>::value) == nullptr)
    throw SceneError(method + ": call it on a node with a colon, node:" + method + "(...); got " +
                     description(L, 1));
  return *static_cast<const NodeValue*>(lua_touserdata(L, 1));
}

/// Throws unless just `wanted` arguments follow the node.
void check_count(lua_State* L, int wanted, const std::string& method, const char* form) {
  if (lua_gettop(L) - 1 != wanted)
    throw SceneError(method + ": takes " + form + ", got " + std::to_string(lua_gettop(L) - 1) + " values");
}

// Transforms. -----------------------------------------------------------------------------------------------

int push_transformed(lua_State* L, const Affine& by) {
  NodeValue& copy = push_copy(L, 1);
  copy.parent_from_node = by * copy.parent_from_node;
  return 1;
}

/// Three numbers, or one table of three, from the first argument on; answers the index after them.
int read_vector(lua_State* L, const std::string& method, glm::dvec3& v) {
  if (lua_type(L, 2) == LUA_TTABLE) {
    v = vector_at(L, 2, method);
    return 3;
  }
  for (int i = 0; i < 3; ++i) v[i] = number_at(L, 2 + i, method + ": " + "xyz"[i]);
  return 5;
}

int translate(lua_State* L) {
  self(L, "translate");
  glm::dvec3 by;
  check_count(L, read_vector(L, "translate", by) - 2, "translate", "three numbers or {x, y, z}");
  return push_transformed(L, translation(by));
}

int scale(lua_State* L) {
  self(L, "scale");
  glm::dvec3 by;
  if (lua_gettop(L) == 2 && lua_type(L, 2) == LUA_TNUMBER)
    by = glm::dvec3(number_at(L, 2, "scale: the factor"));
  else
    check_count(L, read_vector(L, "scale", by) - 2, "scale", "one or three numbers or {x, y, z}");
  for (int i = 0; i < 3; ++i)
    if (by[i] == 0) throw SceneError("scale: a factor of 0 makes the node flat, it must not be 0");
  return push_transformed(L, scaling(by));
}

int rotate_axis(lua_State* L, int axis, const std::string& method) {
  self(L, method);
  check_count(L, 1, method, "one number, the angle in degrees");
  return push_transformed(L, rotation_deg(axis, number_at(L, 2, method + ": the angle")));
}
int rotate_x(lua_State* L) { return rotate_axis(L, 0, "rotate_x"); }
int rotate_y(lua_State* L) { return rotate_axis(L, 1, "rotate_y"); }
int rotate_z(lua_State* L) { return rotate_axis(L, 2, "rotate_z"); }

int rotate(lua_State* L) {
  self(L, "rotate");
  glm::dvec3 axis;
  const int next = read_vector(L, "rotate", axis);
  check_count(L, next - 1, "rotate", "the axis (three numbers or {x, y, z}) and the angle in degrees");
  if (axis == glm::dvec3(0.0)) throw SceneError("rotate: the axis must not be {0, 0, 0}");
  return push_transformed(L, rotation_deg(axis, number_at(L, next, "rotate: the angle")));
}

/// matrix{ {a, b, c, d}, {e, f, g, h}, {i, j, k, l} }: x' = a x + b y + c z + d, and so on.
int matrix(lua_State* L) {
  self(L, "matrix");
  const char* const form = "three rows of four numbers, { {a, b, c, d}, {e, f, g, h}, {i, j, k, l} }";
  check_count(L, 1, "matrix", form);
  const auto require_length = [&](int index, lua_Unsigned length) {
    if (lua_type(L, index) != LUA_TTABLE || lua_rawlen(L, index) != length)
      throw SceneError(std::string("matrix: takes ") + form);
  };
  require_length(2, 3);
  Affine m;
  for (int row = 0; row < 3; ++row, lua_pop(L, 1)) {
    lua_rawgeti(L, 2, row + 1);
    require_length(-1, 4);
    for (int column = 0; column < 4; ++column, lua_pop(L, 1)) {
      lua_rawgeti(L, -1, column + 1);
      (column < 3 ? m.linear[column] : m.offset)[row] = number_at(L, -1, "matrix: an entry");
    }
  }
  if (!is_invertible(m)) throw SceneError("matrix: cannot be inverted, its columns must span space");
  return push_transformed(L, m);
}

// Attributes: a second call replaces what the first one set. ------------------------------------------------

/// Pushes a copy of the node with the value at the index as its companion.
NodeValue& push_with(lua_State* L, Companion companion, int index) {
  NodeValue& copy = push_copy(L, 1);
  lua_pushvalue(L, index);
  lua_setiuservalue(L, -2, companion);
  return copy;
}

int set_material(lua_State* L) {
  self(L, "material");
  check_count(L, 1, "material", "one material, phong{ ... }");
  const Material& given = value_at<Material>(L, 2, "material: its argument");
  push_with(L, Companion::material, 2).material = &given;
  return 1;
}

int set_color(lua_State* L) {
  self(L, "color");
  check_count(L, 1, "color", "one color, {r, g, b} or a number");
  const glm::dvec3 color = color_at(L, 2, "color");
  push_copy(L, 1).color = color;
  return 1;
}

int set_texture(lua_State* L) {
  self(L, "texture");
  const int count = lua_gettop(L) - 1;
  if (count == 0) throw SceneError("texture: takes one texture or more, such as checker{1, 1, {1, 1, 1}}");
  lua_createtable(L, count, 0);
  for (int i = 1; i <= count; ++i) {
    value_at<Texture>(L, 1 + i, "texture: argument " + std::to_string(i));
    lua_pushvalue(L, 1 + i);
    lua_rawseti(L, -2, i);
  }
  push_with(L, Companion::textures, lua_gettop(L));
  return 1;
}

int set_no_shadow(lua_State* L) {
  self(L, "no_shadow");
  check_count(L, 0, "no_shadow", "nothing");
  push_copy(L, 1).no_shadow = true;
  return 1;
}

int set_name(lua_State* L) {
  self(L, "name");
  check_count(L, 1, "name", "one string");
  if (lua_type(L, 2) != LUA_TSTRING) throw SceneError("name: must be a string, is " + description(L, 2));
  if (lua_rawlen(L, 2) > 100) throw SceneError("name: must have at most 100 characters");
  if (!is_plain_text({lua_tostring(L, 2), lua_rawlen(L, 2)}))
    throw SceneError("name: must be one line of UTF-8 without control characters");
  push_with(L, Companion::name, 2);
  return 1;
}

const std::vector<luaL_Reg>& methods() {
  static const std::vector<luaL_Reg> all{
      {"translate", guarded<translate>},     {"scale", guarded<scale>},
      {"rotate_x", guarded<rotate_x>},       {"rotate_y", guarded<rotate_y>},
      {"rotate_z", guarded<rotate_z>},       {"rotate", guarded<rotate>},
      {"matrix", guarded<matrix>},           {"material", guarded<set_material>},
      {"color", guarded<set_color>},         {"texture", guarded<set_texture>},
      {"no_shadow", guarded<set_no_shadow>}, {"name", guarded<set_name>}};
  return all;
}

int unknown_method(lua_State* L) {
  const std::string name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : description(L, 2);
  throw SceneError("a node has no method '" + name.substr(0, 40) + "'" + suggestion(name, method_names()));
}

}  // namespace

void open_node_methods(lua_State* L) {
  luaL_newmetatable(L, LuaName<NodeValue>::value);
  lua_createtable(L, 0, static_cast<int>(methods().size()));
  for (const luaL_Reg& method : methods()) {
    lua_pushcfunction(L, method.func);
    lua_setfield(L, -2, method.name);
  }
  lua_createtable(L, 0, 1);
  lua_pushcfunction(L, guarded<unknown_method>);
  lua_setfield(L, -2, "__index");
  lua_setmetatable(L, -2);
  lua_setfield(L, -2, "__index");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 1);
}

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const luaL_Reg& method : methods()) all.push_back(method.name);
    return all;
  }();
  return names;
}

}  // namespace rayfarm
