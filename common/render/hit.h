// A point on the scene's surface: everything shading asks about it.
#pragma once
#include "common/geometry/ray.h"
#include "common/render/world_parts.h"

namespace rayfarm {

struct Hit {
  double t = 0, t_error = 0;  // along the ray that came; tight where World::Parts::asks_for_errors()
  Vec3d point{};
  double point_error = 0;  // of each coordinate
  Vec3d normal{};          // unit, out of the material, whichever way the ray came
  Vec3d color{};           // of the surface, textures applied
  const Material* material = nullptr;
  double index = 1;  // of refraction: the material's side over the other
  std::uint32_t leaf = 0;
  std::uint32_t surface = 0;   // Leaf::surface
  bool leaf_entering = false;  // the ray goes into the leaf
  bool entering = false;       // the ray goes into the material: it came from outside
  std::uint32_t inner = unknown_medium, outer = unknown_medium;  // what fills both sides: nested media
  bool is_sheet = false;         // the leaf has no inside: what lies behind it is not known
  std::uint32_t part = no_part;  // of the leaf, where it has such
};

Hit hit_at(const World::Parts& world, const RayQuery& ray, const Boundary& boundary);

/// As Hit::normal, but where that is interpolated, that of the triangle itself. The ray is the one that came.
Vec3d facet_normal(const World::Parts& world, const Ray& ray, const Hit& hit);

/// A hash of the cells of all textures in which the hit lies.
std::uint64_t texture_cells(const World::Parts& world, const Ray& ray, const Hit& hit);

/// Whether a ray sent to a side, or into a medium, cannot have come to that hit.
inline bool contradicts(const Ray& ray, const Hit& hit) {
  if (ray.medium != unknown_medium) return ray.medium != (hit.entering ? hit.outer : hit.inner);
  return contradicts(ray.side, hit.entering);
}

/// A ray that leaves the hit on the outer (or inner) side of the material.
Ray ray_from(const Hit& hit, const Vec3d& direction, bool outside);

}  // namespace rayfarm
