// Small scenes for the cases, and what our renderer finds along a ray in them.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "common/render/world_parts.h"
#include "tests/common/geometry/rays.h"

namespace rayfarm::stability {

inline Node solid_node(const Solid& solid, const Affine& map = {}) { return {solid, map, {}, {}, {}, {}}; }
inline Node operation_node(CsgOp op, std::uint32_t children) {
  return {Operation{op, children}, {}, {}, {}, {}, {}};
}
inline Scene scene_of(std::vector<Node> nodes) {
  Scene scene;
  scene.nodes = std::move(nodes);
  return scene;
}

/// Two chains of transforms that are the same in exact arithmetic: rotations about one axis, in one step or two,
/// moves in one step or two, stretches by up to 10^decades.
inline std::array<Affine, 2> twin_chains(RandomRays& random, double decades = 0) {
  const double a = random.uniform(-180, 180), b = random.uniform(-180, 180);
  const auto factor = [&] { return std::pow(10.0, random.uniform(-decades, decades)); };
  const Affine stretch = scaling({factor(), factor(), factor()});
  const glm::dvec3 axis{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)};
  const Vec3d m = random.in_box(3), n = random.in_box(3);
  const Affine first = translation({m.x, m.y, m.z}), second = translation({n.x, n.y, n.z});
  const glm::dvec3 both{m.x + n.x, m.y + n.y, m.z + n.z};
  return {translation(both) * rotation_deg(axis, a + b) * stretch,
          first * second * rotation_deg(axis, a) * rotation_deg(axis, b) * stretch};
}

/// The boundaries of all objects of a world along a ray, in each object's order.
inline std::vector<Boundary> boundaries_of(const World& world, const Ray& ray, CsgWorkspace& workspace) {
  std::vector<Boundary> found;
  for (const WorldObject& object : world.parts().objects) {
    const auto items = world.parts().items_of(object);
    gather(items, world.parts().leaves, RayQuery(ray), infinity, workspace);
    Boundary b;
    for (std::size_t next = 0; next_boundary(items, workspace, next, b);) found.push_back(b);
  }
  return found;
}

inline Vec3d moved(const Affine& by, const Vec3d& p) { return vec(point(by, {p.x, p.y, p.z})); }

/// From that far away, in any direction, towards a point.
inline Ray ray_towards(const Vec3d& target, double distance, RandomRays& random) {
  Ray ray;
  ray.origin = target + random.direction() * distance;
  ray.direction = normalized(target - ray.origin);
  return ray;
}

}  // namespace rayfarm::stability
