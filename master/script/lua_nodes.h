// Nodes of the tree for scripts: solids, set operations, and the methods that give a changed copy.
#pragma once
#include <lua.h>

#include <string_view>
#include <vector>

#include "common/scene/scene.h"
#include "master/script/lua_values.h"

namespace rayfarm {

/// Makes sphere{} cube{} plane{} cylinder{} torus{}, union{} intersection{} difference{} xor{} known to
/// scripts.
void open_nodes(lua_State* L);
/// Makes the methods of nodes known: translate, material, ...
void open_node_methods(lua_State* L);

/// Appends the tree of the node at the index to scene.nodes in preorder, its materials to scene.materials.
void append_tree(lua_State* L, int index, Scene& scene);

/// What open_nodes() and open_node_methods() make known.
const std::vector<Signature>& node_signatures();
const std::vector<std::string>& method_names();

}  // namespace rayfarm
