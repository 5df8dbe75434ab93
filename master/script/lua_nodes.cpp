#include "master/script/lua_nodes.h"

#include <algorithm>
#include <unordered_map>

#include "master/script/node_value.h"

namespace rayfarm {
namespace {

const Signature sphere_signature{"sphere", {}};
const Signature cube_signature{"cube", {}};
const Signature plane_signature{"plane", {}};
const Signature cylinder_signature{"cylinder", {"zmin", "zmax"}, 2};
const Signature cone_signature{"cone", {"zmin", "zmax"}, 2};
const Signature torus_signature{"torus", {"R", "r"}, 2};
const Signature rounded_cube_signature{"rounded_cube", {"r"}, 1};
const Signature glow_sphere_signature{"glow_sphere", {"color", "exponent"}};
const Signature glow_cylinder_signature{"glow_cylinder", {"zmin", "zmax", "color", "exponent"}, 2};

int make_sphere(lua_State* L) {
  const Fields none(L, 1, sphere_signature);
  return push_content(L, Sphere{});
}
int make_cube(lua_State* L) {
  const Fields none(L, 1, cube_signature);
  return push_content(L, Cube{});
}
int make_plane(lua_State* L) {
  const Fields none(L, 1, plane_signature);
  return push_content(L, Plane{});
}
/// A solid about the z axis between two limits.
template <class S>
S read_limited(const Fields& fields) {
  S solid;
  solid.z_min = fields.number("zmin", solid.z_min, Range::infinite_too);
  solid.z_max = fields.number("zmax", solid.z_max, Range::infinite_too);
  if (!(solid.z_min < solid.z_max)) throw SceneError(fields.function() + ": zmin must be below zmax");
  return solid;
}
int make_cylinder(lua_State* L) {
  return push_content(L, read_limited<Cylinder>(Fields(L, 1, cylinder_signature)));
}
int make_cone(lua_State* L) { return push_content(L, read_limited<Cone>(Fields(L, 1, cone_signature))); }
int make_torus(lua_State* L) {
  const Fields fields(L, 1, torus_signature);
  Torus torus;
  torus.R = fields.number("R", torus.R, Range::positive);
  torus.r = fields.number("r", torus.r, Range::positive);
  return push_content(L, torus);
}

int make_rounded_cube(lua_State* L) {
  const Fields fields(L, 1, rounded_cube_signature);
  RoundedCube cube;
  cube.r = fields.number("r", cube.r, Range::positive);
  if (cube.r > 0.5) throw SceneError(fields.place("r") + " must be at most 0.5, is " + text_of(cube.r));
  return push_content(L, cube);
}

// Glow shells. ----------------------------------------------------------------------------------------------

template <class Shape>
int push_glow(lua_State* L, const Fields& fields, const Shape& shape) {
  Glow glow;
  glow.shape = shape;
  glow.color = fields.color("color", glow.color);
  glow.exponent = fields.integer("exponent", glow.exponent, 0, max_exponent);
  return push_content(L, glow);
}
int make_glow_sphere(lua_State* L) { return push_glow(L, Fields(L, 1, glow_sphere_signature), Sphere{}); }
int make_glow_cylinder(lua_State* L) {
  const Fields fields(L, 1, glow_cylinder_signature);
  return push_glow(L, fields, read_limited<Cylinder>(fields));
}

// Set operations. -------------------------------------------------------------------------------------------

/// The table at 1 must be a plain list of nodes; answers its length.
std::uint32_t list_length(lua_State* L, const std::string& function) {
  if (lua_type(L, 1) != LUA_TTABLE)
    throw SceneError(function + ": expects a list of nodes, write " + function + "{ a, b }; got " +
                     description(L, 1));
  const lua_Unsigned length = lua_rawlen(L, 1);
  if (length > max_nodes)
    throw SceneError(function + ": a list of more than " + std::to_string(max_nodes) + " nodes");

  lua_Unsigned entries = 0;
  for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1), ++entries)
    if (lua_type(L, -2) == LUA_TSTRING)
      throw SceneError(function + ": unknown key '" + std::string(lua_tostring(L, -2)).substr(0, 40) +
                       "', it takes a list of nodes only");
  if (entries == 0) throw SceneError(function + ": the list is empty, it needs at least one node");
  if (entries != length) throw SceneError(function + ": the list has holes, is an entry nil?");
  return static_cast<std::uint32_t>(length);
}

/// union{ a, b, ... }: the list is copied, so that the script may go on changing its own.
template <CsgOp op>
int make_operation(lua_State* L, const std::string& function) {
  const std::uint32_t length = list_length(L, function);
  NodeValue node;
  node.content = Operation{op, length};
  lua_createtable(L, static_cast<int>(length), 0);
  for (std::uint32_t i = 1; i <= length; ++i) {
    lua_rawgeti(L, 1, i);
    const NodeValue& child = value_at<NodeValue>(L, -1, function + ": entry " + std::to_string(i));
    node.nodes += child.nodes;
    node.levels = std::max(node.levels, child.levels + 1);
    lua_rawseti(L, -2, i);
    if (node.nodes > max_nodes)
      throw SceneError(function + ": the tree has more than " + std::to_string(max_nodes) +
                       " nodes (a node used twice counts twice)");
  }
  if (node.levels > max_tree_depth)
    throw SceneError(function + ": the tree is more than " + std::to_string(max_tree_depth) + " levels deep");
  push_node(L, node);
  lua_insert(L, -2);
  lua_setiuservalue(L, -2, Companion::children);
  return 1;
}
int make_union(lua_State* L) { return make_operation<CsgOp::unite>(L, "union"); }
int make_intersection(lua_State* L) { return make_operation<CsgOp::intersect>(L, "intersection"); }
int make_difference(lua_State* L) { return make_operation<CsgOp::subtract>(L, "difference"); }
int make_xor(lua_State* L) { return make_operation<CsgOp::exclusive_or>(L, "xor"); }

// The tree of a scene. --------------------------------------------------------------------------------------

/// Turns node values into a scene's preorder. A material used by many nodes is one in the scene.
class TreeWriter {
 public:
  TreeWriter(lua_State* L, Scene& scene) : L_(L), scene_(scene) {}

  /// No deeper than max_tree_depth: every operation has seen to that.
  void append(int index) {
    luaL_checkstack(L_, 8, "the tree is too deep");
    const NodeValue& value = *static_cast<const NodeValue*>(lua_touserdata(L_, index));
    Node& node = scene_.nodes.emplace_back();
    node.content = value.content;
    node.parent_from_node = value.parent_from_node;
    node.color = value.color;
    node.no_shadow = value.no_shadow;
    if (value.material) node.material = number_of(*value.material);
    append_textures(index, node);
    if (lua_getiuservalue(L_, index, Companion::name) == LUA_TSTRING) node.name = lua_tostring(L_, -1);
    lua_pop(L_, 1);

    const auto* operation = std::get_if<Operation>(&value.content);
    if (!operation) return;
    lua_getiuservalue(L_, index, Companion::children);
    for (std::uint32_t i = 1; i <= operation->children; ++i, lua_pop(L_, 1)) {
      lua_rawgeti(L_, -1, i);
      append(lua_gettop(L_));
    }
    lua_pop(L_, 1);
  }

 private:
  std::uint32_t number_of(const Material& material) {
    const auto [known, is_new] =
        numbers_.try_emplace(&material, static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) scene_.materials.push_back(material);
    return known->second;
  }

  void append_textures(int index, Node& node) {
    if (lua_getiuservalue(L_, index, Companion::textures) == LUA_TTABLE)
      for (lua_Unsigned i = 1, n = lua_rawlen(L_, -1); i <= n; ++i, lua_pop(L_, 1)) {
        lua_rawgeti(L_, -1, static_cast<lua_Integer>(i));
        node.textures.push_back(*static_cast<const Texture*>(lua_touserdata(L_, -1)));
      }
    lua_pop(L_, 1);
  }

  lua_State* L_;
  Scene& scene_;
  std::unordered_map<const Material*, std::uint32_t> numbers_;
};

}  // namespace

void append_tree(lua_State* L, int index, Scene& scene) {
  const NodeValue& root = value_at<NodeValue>(L, index, "scene: root");
  scene.nodes.reserve(scene.nodes.size() + root.nodes);
  TreeWriter(L, scene).append(lua_absindex(L, index));
}

void open_nodes(lua_State* L) {
  lua_register(L, "sphere", guarded<make_sphere>);
  lua_register(L, "cube", guarded<make_cube>);
  lua_register(L, "plane", guarded<make_plane>);
  lua_register(L, "cylinder", guarded<make_cylinder>);
  lua_register(L, "cone", guarded<make_cone>);
  lua_register(L, "torus", guarded<make_torus>);
  lua_register(L, "rounded_cube", guarded<make_rounded_cube>);
  lua_register(L, "glow_sphere", guarded<make_glow_sphere>);
  lua_register(L, "glow_cylinder", guarded<make_glow_cylinder>);
  lua_register(L, "union", guarded<make_union>);
  lua_register(L, "intersection", guarded<make_intersection>);
  lua_register(L, "difference", guarded<make_difference>);
  lua_register(L, "xor", guarded<make_xor>);
}

const std::vector<Signature>& node_signatures() {
  static const std::vector<Signature> all{sphere_signature,
                                          cube_signature,
                                          plane_signature,
                                          cylinder_signature,
                                          cone_signature,
                                          torus_signature,
                                          rounded_cube_signature,
                                          glow_sphere_signature,
                                          glow_cylinder_signature,
                                          {"union", {}},
                                          {"intersection", {}},
                                          {"difference", {}},
                                          {"xor", {}}};
  return all;
}

}  // namespace rayfarm
