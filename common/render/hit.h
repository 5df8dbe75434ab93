// A point on the scene's surface: everything shading asks about it.
#pragma once
#include "common/geometry/ray.h"
#include "common/render/world_parts.h"

namespace rayfarm {

struct Hit {
  double t = 0, t_error = 0;  // along the ray that came
  Vec3d point{};
  double point_error = 0;  // of each coordinate
  Vec3d normal{};          // unit, out of the material, whichever way the ray came
  Vec3d color{};           // of the surface, textures applied
  const Material* material = nullptr;
  std::uint32_t leaf = 0;
  bool leaf_entering = false;  // the ray goes into the leaf
  bool entering = false;       // the ray goes into the material: it came from outside
};

Hit hit_at(const World::Parts& world, const RayQuery& ray, const Boundary& boundary);

/// A hash of the cells of all textures in which the hit lies.
std::uint64_t texture_cells(const World::Parts& world, const Ray& ray, const Hit& hit);

/// A ray that leaves the hit on the outer (or inner) side of the material.
Ray ray_from(const Hit& hit, const Vec3d& direction, bool outside);

}  // namespace rayfarm
