// The half-space z < 0. A line parallel to its face is inside for ever or never: an interval, not a list of
// hits.
#pragma once
#include "common/geometry/cube.h"

namespace rayfarm {

template <class T>
Interval<T> plane_interval(const LocalRay<T>& r) {
  return slab_interval(r, 2, T(-infinity), T(0));
}

inline SurfacePoint plane_surface(const LocalRay<double>& r, double t) {
  const Vec3d p = r.origin + r.direction * t;
  return {{p.x, p.y, 0}, {0, 0, 1}};
}

inline TextureCoordinates plane_texture(const Vec3d& p) { return {p.x, p.y}; }

}  // namespace rayfarm
