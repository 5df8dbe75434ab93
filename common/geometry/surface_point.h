// A point of a solid's surface in its local space, and its texture coordinates.
#pragma once
#include "common/math/vec.h"

namespace rayfarm {

struct SurfacePoint {
  Vec3d point{};   // put back onto the surface, so its own error is a few ulp of the solid's size
  Vec3d normal{};  // outward from the solid, any length > 0
};

struct TextureCoordinates {
  double u = 0, v = 0;
};

}  // namespace rayfarm
