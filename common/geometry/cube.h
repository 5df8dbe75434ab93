// The cube [0,1]^3, as three slabs.
// Source: T. L. Kay and J. T. Kajiya, Ray Tracing Complex Scenes, SIGGRAPH 1986 (slabs).
#pragma once
#include "common/geometry/crossing.h"
#include "common/geometry/ray.h"
#include "common/geometry/solid.h"
#include "common/geometry/surface_point.h"

namespace rayfarm {

/// Where the line is between the planes `low` and `high` of one axis. A direction within its own error of
/// parallel never crosses them: the line is between them, or it is not; within its error of one of them it counts
/// as moved aside.
template <class T>
Interval<T> slab_interval(const LocalRay<T>& r, int axis, T low, T high) {
  using std::fabs;
  const T o = r.origin[axis], d = r.direction[axis];
  if (none(fabs(d) > r.direction_error)) {
    const T aside = select(r.aside[axis] > T(0), r.origin_error, -r.origin_error);
    return o + aside > low && o + aside < high ? Interval<T>{} : empty_interval<T>();
  }
  const T a = (low - o) / d, b = (high - o) / d;
  const auto error = [&](T t) {
    return (r.origin_error + fabs(t) * r.direction_error) / (fabs(d) - r.direction_error) +
           T(3 * unit_roundoff) * fabs(t);
  };
  const T first = select(d > T(0), a, b), last = select(d > T(0), b, a);
  // An open slab (an uncapped cylinder) has no planes at infinity.
  Interval<T> inside;
  if (first > T(-infinity)) inside.enter = bounded(first, error(first));
  if (last < T(infinity)) inside.leave = bounded(last, error(last));
  return inside;
}

template <class T>
Interval<T> interval_of(const Cube&, const LocalRay<T>& r) {
  Interval<T> inside;
  for (int axis = 0; axis < 3; ++axis) inside = intersection(inside, slab_interval(r, axis, T(0), T(1)));
  return inside;
}

inline Bounded<double> exit_from_surface(const Cube& cube, const LocalRay<double>& r) {
  return interval_of(cube, r).leave;
}

/// The axis whose plane the ray passes where it enters (or leaves) the cube.
template <class T>
int cube_face_axis(const LocalRay<T>& r, bool entering) {
  int face = 0;
  T best = T(entering ? -infinity : infinity);
  for (int axis = 0; axis < 3; ++axis) {
    const T d = r.direction[axis], o = r.origin[axis];
    using std::fabs;
    if (!(fabs(d) > r.direction_error)) continue;
    const T t = ((d > T(0)) == entering ? T(0) - o : T(1) - o) / d;
    if (entering ? t > best : t < best) best = t, face = axis;
  }
  return face;
}

inline SurfacePoint surface_of(const Cube&, const LocalRay<double>& r, double t, bool entering) {
  const int axis = cube_face_axis(r, entering);
  const bool high = (r.direction[axis] > 0) != entering;
  Vec3d p = r.origin + r.direction * t, n{};
  for (int i = 0; i < 3; ++i) p[i] = least(greatest(p[i], 0), 1);
  p[axis] = high ? 1 : 0;
  n[axis] = high ? 1 : -1;
  return {p, n};
}

/// Faces +-x show (y, z), +-y (x, z), +-z (x, y).
inline TextureCoordinates texture_of(const Cube&, const SurfacePoint& s) {
  const Vec3d &p = s.point, &n = s.normal;
  if (n.x != 0) return {p.y, p.z};
  if (n.y != 0) return {p.x, p.z};
  return {p.x, p.y};
}

inline Extent extent_of(const Cube&, const Vec3d& row) {
  return {least(row.x, 0) + least(row.y, 0) + least(row.z, 0),
          greatest(row.x, 0) + greatest(row.y, 0) + greatest(row.z, 0)};
}
inline double size_of(const Cube&) { return 1; }

}  // namespace rayfarm
