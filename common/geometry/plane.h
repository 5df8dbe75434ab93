// The half-space z < 0. A line parallel to its face is inside for ever or never: an interval, not a list of
// hits.
#pragma once
#include "common/geometry/cube.h"

namespace rayfarm {

template <class T>
Interval<T> interval_of(const Plane&, const LocalRay<T>& r) {
  return slab_interval(r, 2, T(-infinity), T(0));
}

[[gnu::always_inline]] inline Glance glance_at(const Plane&, const LocalRay<double>& r) {
  const double o = r.origin.z, d = r.direction.z, off = r.origin_error, turn = r.direction_error;
  if (!(std::fabs(d) > r.spread)) return {};
  if (std::fabs(o) > off && (o > 0) == (d > 0))  // away from the face
    return o > 0 ? Glance::missing() : Glance::passing(-infinity, infinity, 0);
  const double t = -o / d, far = std::fabs(t);
  const double blur = (off + far * turn) * (1 / (std::fabs(d) - turn)) + 5 * unit_roundoff * far;
  return d > 0 ? Glance::passing(-infinity, t, blur) : Glance::passing(t, infinity, blur);
}

/// Inward there is no other face.
inline Bounded<double> exit_from_surface(const Plane&, const LocalRay<double>&) {
  return bounded(infinity, 0.0);
}

inline SurfacePoint surface_of(const Plane&, const LocalRay<double>& r, double t, bool) {
  const Vec3d p = r.origin + r.direction * t;
  return {{p.x, p.y, 0}, {0, 0, 1}};
}

inline TextureCoordinates texture_of(const Plane&, const SurfacePoint& s) { return {s.point.x, s.point.y}; }

inline Extent extent_of(const Plane&, const Vec3d& row) {
  if (row.x != 0 || row.y != 0) return {-infinity, infinity};
  return row.z > 0 ? Extent{-infinity, 0} : Extent{0, infinity};
}
inline double size_of(const Plane&) { return 1; }

}  // namespace rayfarm
