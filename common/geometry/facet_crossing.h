// Where a line passes a surface of many parts: triangles or patches.
#pragma once
#include <cstdint>

#include "common/geometry/ray.h"
#include "common/geometry/surface_point.h"

namespace rayfarm {

struct FacetCrossing {
  double t, error;
  std::uint32_t part;
  bool entering;  // against the normal: from the front to the back

  double lo() const { return t - error; }
  double hi() const { return t + error; }
};

/// The surface there, in local space.
struct FacetPoint {
  SurfacePoint surface;
  double error = 0;  // of each coordinate of the point, beyond a few ulp of itself
  TextureCoordinates texture;
};

}  // namespace rayfarm
