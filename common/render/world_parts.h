// The inside of a World, for the tracer: flat arrays, in the order of the scene's tree.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/bvh.h"
#include "common/geometry/csg.h"
#include "common/geometry/leaf.h"
#include "common/render/glow_shell.h"
#include "common/render/world.h"

namespace rayfarm {

/// How a leaf looks, all inheritance resolved.
struct LeafSurface {
  Vec3d color{};
  std::uint32_t material = 0;                     // index into Parts::materials
  std::uint32_t first_texture = 0, textures = 0;  // range of Parts::textures, those of ancestors first
  bool casts_shadow = true;
};

/// A subtree of the scene that has no union above it but unions: what a ray hits first is the first of all
/// objects'.
struct WorldObject {
  std::uint32_t first_item = 0, item_count = 0;  // range of Parts::items
};

/// An object as the hierarchy's leaves name it.
struct ObjectRef {
  std::uint32_t object = 0;
  std::uint32_t leaf = no_leaf;    // when the object is a single leaf
  std::uint32_t facets = no_leaf;  // when it is a single leaf with facets
};

struct World::Parts {
  Scene scene;
  std::vector<Leaf> leaves;
  std::vector<Placement> placements;  // per leaf
  std::vector<LeafSurface> surfaces;  // per leaf
  std::vector<Material> materials;    // the scene's, then the default one
  std::vector<Texture> textures;
  std::vector<CsgItem> items;
  std::vector<WorldObject> objects;
  std::vector<ObjectRef> endless_objects;  // whose bounds are infinite: tried for every ray
  std::vector<ObjectRef> bounded_objects;  // in the order of the hierarchy
  Bvh bvh;
  bool all_cast_shadows = true;
  std::vector<GlowShell> glows;  // in the order of the tree

  /// Whether how exact a hit is matters to more than what else is hit there.
  bool asks_for_errors() const { return !glows.empty(); }

  std::span<const CsgItem> items_of(const WorldObject& object) const {
    return {items.data() + object.first_item, object.item_count};
  }
};

/// Where an object's surface counts among those of others that overlap it.
struct UnionEvent {
  double lo, hi;
  std::uint32_t object;
  Boundary boundary;
};

/// Memory for one thread's rays.
template <class Csg>
struct WorkspaceWith {
  Csg csg;
  std::vector<UnionEvent> events;
  std::vector<std::uint32_t> filling;  // see nested_media.h
};
using WorldWorkspace = WorkspaceWith<CsgWorkspace>;
using CountingWorkspace = WorkspaceWith<CountingCsgWorkspace>;

/// The first boundary of the scene's union ahead of the ray.
template <class Csg>
std::optional<Boundary> first_boundary(const World::Parts& world, const RayQuery& ray,
                                       WorkspaceWith<Csg>& workspace);

/// The same in a scene with nested media, where first_boundary() leads.
template <class Csg>
std::optional<Boundary> first_change_of_medium(const World::Parts& world, const RayQuery& ray,
                                               WorkspaceWith<Csg>& workspace);

/// Whether a surface that casts shadows stands at 0 < t <= 1 of a ray that starts outside all material.
template <class Csg>
bool is_blocked(const World::Parts& world, const RayQuery& ray, WorkspaceWith<Csg>& workspace);

/// The first such surface, as each object alone has it.
std::optional<Boundary> first_blocker(const World::Parts& world, const RayQuery& ray,
                                      WorldWorkspace& workspace);

/// Whether the ray's far end lies in endless material.
bool ends_inside(const World::Parts& world, const RayQuery& ray, WorldWorkspace& workspace);

}  // namespace rayfarm
