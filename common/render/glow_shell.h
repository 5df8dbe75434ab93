// A Glow of the scene made ready for rays.
#pragma once
#include "common/geometry/leaf.h"
#include "common/scene/scene.h"

namespace rayfarm {

struct GlowShell {
  Leaf leaf;  // of a tube: endless
  double z_min, z_max;
  Vec3d color{};
  std::uint32_t exponent;
};

GlowShell make_glow_shell(const Glow& glow, const BoundedAffine& world_from_local);

}  // namespace rayfarm
