// The half-space z < 0. A line parallel to its face is inside for ever or never: an interval, not a list of
// hits.
#pragma once
#include "common/geometry/cube.h"

namespace rayfarm {

template <class T>
Interval<T> plane_interval(const LocalRay<T>& r) {
  return slab_interval(r.origin.z, r.direction.z, T(-infinity), T(0), r.origin_error, r.direction_error);
}

inline SurfacePoint plane_surface(const LocalRay<double>& r, double t) {
  const Vec3d p = r.origin + r.direction * t;
  return {{p.x, p.y, 0}, {0, 0, 1}};
}

inline TextureCoordinates plane_texture(const Vec3d& p) { return {p.x, p.y}; }

}  // namespace rayfarm
