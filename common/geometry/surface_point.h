// A point of a solid's surface in its local space, its texture coordinates, and how far a solid reaches.
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

/// The range of a solid's points along an axis.
struct Extent {
  double low, high;
};

inline Extent about_zero(double half) { return {-half, half}; }

}  // namespace rayfarm
