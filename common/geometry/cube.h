// The cube [0,1]^3, as three slabs.
// Source: T. L. Kay and J. T. Kajiya, Ray Tracing Complex Scenes, SIGGRAPH 1986 (slabs).
#pragma once
#include "common/geometry/crossing.h"
#include "common/geometry/ray.h"
#include "common/geometry/solid.h"
#include "common/geometry/surface_point.h"

namespace rayfarm {

/// A line that counts as parallel to something: its point where it passes the solid, with what that may be off by.
template <class T>
struct PassingPoint {
  Vec3<T> p;
  T error;
};

template <class T>
PassingPoint<T> passing_point(const LocalRay<T>& r) {
  using std::fabs;
  const Vec3<T>&o = r.origin, &d = r.direction;
  const int along = fabs(d.x) > fabs(d.y) ? (fabs(d.x) > fabs(d.z) ? 0 : 2) : (fabs(d.y) > fabs(d.z) ? 1 : 2);
  const T per_d = T(1) / fabs(d[along]), far = fabs(o[along]) * per_d;
  return {o + d * -(o[along] / d[along]), r.origin_error + far * r.direction_error + T(2) * r.spread * per_d +
                                              T(2 * unit_roundoff_of<T>) * max_abs(o)};
}

/// A line along the planes: it is between them, or it is not; within its error of one of them it counts as moved
/// aside.
template <class T>
Interval<T> parallel_to_slab(const LocalRay<T>& r, int axis, T low, T high) {
  using std::fabs;
  const PassingPoint<T> at = passing_point(r);
  const T x = at.p[axis], error = at.error * r.share[axis];
  const bool in_low = fabs(x - low) <= error, in_high = fabs(x - high) <= error;
  const bool above = in_low ? r.aside[axis] > T(0) : x > low;
  const bool below = in_high ? r.aside[axis] < T(0) : x < high;
  Interval<T> inside = above && below ? Interval<T>{} : empty_interval<T>();
  inside.wants_digits = in_low || in_high || fabs(r.direction[axis]) > T(0);
  return inside;
}

/// Where the line is between the planes `low` and `high` of one axis, which may be endlessly far. With o and d off by
/// e and f, t = (low - o) / d is off by (e + |t| f) / (|d| - f) and three roundings.
template <class T>
Interval<T> slab_interval(const LocalRay<T>& r, int axis, T low, T high) {
  using std::fabs;
  const T o = r.origin[axis], d = r.direction[axis], share = r.share[axis];
  if (none(fabs(d) > r.spread * share)) return parallel_to_slab(r, axis, low, high);
  const T o_error = r.origin_error * share, d_error = r.direction_error * share;
  const T per_d = T(1) / (fabs(d) - d_error);
  const auto passing = [&](T plane) {
    const T t = (plane - o) / d;
    return bounded(t, (o_error + fabs(t) * d_error) * per_d + T(3 * unit_roundoff_of<T>) * fabs(t));
  };
  const T near = select(d > T(0), low, high), far = select(d > T(0), high, low);
  Interval<T> inside;
  if (fabs(near) < T(infinity)) inside.enter = passing(near);
  if (fabs(far) < T(infinity)) inside.leave = passing(far);
  return inside;
}

template <class T>
Interval<T> interval_of(const Cube&, const LocalRay<T>& r) {
  Interval<T> inside;
  for (int axis = 0; axis < 3; ++axis) inside = intersection(inside, slab_interval(r, axis, T(0), T(1)));
  return inside;
}

/// Of an axis to which the line is not nearly parallel, by a factor of 2^10 to the axis along which it runs. There t is
/// off by at most 2^12 m / max|d|, m as for the sphere, and 1 / max|d| is the least chord between two of the planes.
[[gnu::always_inline]] inline Glance glance_at(const Cube&, const LocalRay<double>& r) {
  const double along = max_abs(r.direction);
  double enter = -infinity, leave = infinity, chord = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = r.origin[axis], d = r.direction[axis];
    if (!(std::fabs(d) > 0x1p-10 * along)) return {};
    const double low = (0 - o) / d, high = (1 - o) / d;
    const double near = least(low, high), far = greatest(low, high);
    enter = greatest(enter, near), leave = least(leave, far), chord = least(chord, far - near);
  }
  const double blur = chord * 0x1p-17;
  return enter > leave + 2 * blur ? Glance::missing() : Glance::passing(enter, leave, blur);
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
    if (!(fabs(d) > r.spread * r.share[axis])) continue;
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
