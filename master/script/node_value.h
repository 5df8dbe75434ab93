// A node as a Lua value: plain data in Lua's own memory (so that its cap counts it), never changed once made.
#pragma once
#include <lua.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "common/scene/scene.h"
#include "master/script/lua_values.h"

namespace rayfarm {

struct NodeValue {
  NodeContent content;
  Affine parent_from_node;
  const Material* material = nullptr;  // kept alive by Companion::material
  std::optional<glm::dvec3> color;
  bool no_shadow = false;
  std::uint64_t nodes = 1;  // of the tree below, itself included, every shared part counted each time
  std::uint32_t levels = 1;
};

/// The Lua values that live as long as a node.
enum Companion { children = 1, material, textures, name };  // Lua tables of nodes and textures; nil for none
constexpr int companion_count = 4;

template <>
struct LuaName<NodeValue> {
  static constexpr const char* value = "node";
};

inline NodeValue& push_node(lua_State* L, const NodeValue& node) {
  return push_value(L, node, companion_count);
}

/// A node of this content and nothing else; the number of values pushed.
inline int push_content(lua_State* L, const NodeContent& content) {
  NodeValue node;
  node.content = content;
  push_node(L, node);
  return 1;
}

/// Pushes a copy of the node at the index, which shares its companions.
inline NodeValue& push_copy(lua_State* L, int index) {
  index = lua_absindex(L, index);
  NodeValue& copy = push_node(L, *static_cast<const NodeValue*>(lua_touserdata(L, index)));
  for (int i = 1; i <= companion_count; ++i)
    if (lua_getiuservalue(L, index, i) == LUA_TNIL)
      lua_pop(L, 1);
    else
      lua_setiuservalue(L, -2, i);
  return copy;
}

}  // namespace rayfarm
