// What happens to a ray on its way through the scene's tree: where it is inside each leaf, and where the
// set operations leave material.
#pragma once
#include <vector>

#include "common/geometry/ray.h"
#include "common/render/world.h"

namespace rayfarm {

/// Along the ray: in < out, from 0 (the ray starts inside) to infinity (it never gets out).
struct Stretch {
  double in = 0, out = infinity;
  bool operator==(const Stretch&) const = default;
};

struct LeafStretches {
  std::uint32_t leaf = 0;
  bool is_subtracted = false;  // material where the ray is not inside: it stands right of a difference
  std::vector<Stretch> stretches;
};

struct CsgStory {
  std::vector<LeafStretches> leaves;  // those that the ray passes through, by number
  std::vector<Stretch> material;      // what the whole tree makes of them
};

/// The material as the renderer finds it, boundary after boundary. At most 10,000 of them are followed.
CsgStory csg_story(const World& world, const Ray& ray);

}  // namespace rayfarm
