// The cylinder x^2 + y^2 < 1 between z_min and z_max: the interval in the tube, cut by the slab. A line
// parallel to the axis is in the tube for ever or never, so exactly axial rays find the caps.
#pragma once
#include "common/geometry/cube.h"
#include "common/geometry/solid.h"
#include "common/geometry/sphere.h"

namespace rayfarm {

template <class T>
LocalRay<T> across_axis(const LocalRay<T>& r) {
  return {{r.origin.x, r.origin.y, T(0)},
          {r.direction.x, r.direction.y, T(0)},
          r.origin_error,
          r.direction_error,
          r.spread};
}

/// A line along the axis is in the tube for ever or never; within the error of the tube it counts as moved aside.
template <class T>
Interval<T> parallel_to_tube(const LocalRay<T>& r) {
  using std::fabs;
  const PassingPoint<T> at = passing_point(r);
  const T out = at.p.x * at.p.x + at.p.y * at.p.y - T(1);
  const T error = T(3) * at.error + T(4 * unit_roundoff_of<T>);
  const bool in_face = fabs(out) <= error;
  const bool inside = in_face ? at.p.x * r.aside.x + at.p.y * r.aside.y < T(0) : out < T(0);
  Interval<T> tube = inside ? Interval<T>{} : empty_interval<T>();
  tube.wants_digits = in_face || max_abs(across_axis(r).direction) > T(0);
  return tube;
}

template <class T>
Interval<T> tube_interval(const LocalRay<T>& r) {
  const LocalRay<T> flat = across_axis(r);
  // A direction whose square is lost beside its length is as good as parallel.
  const T least_across = r.spread + T(0x1p-100) * max_abs(r.direction);
  if (none(max_abs(flat.direction) > least_across)) return parallel_to_tube(r);
  return interval_of(Sphere{}, flat);
}

template <class T>
Interval<T> interval_of(const Cylinder& c, const LocalRay<T>& r) {
  return intersection(tube_interval(r), slab_interval(r, 2, T(c.z_min), T(c.z_max)));
}

/// A line that is not nearly along the axis, by a factor of 2^6: so much larger than the sphere's is the tube's blur. z
/// is off by less than 2^-23 besides what t is off by.
[[gnu::always_inline]] inline Glance glance_at(const Cylinder& c, const LocalRay<double>& r) {
  const LocalRay<double> flat = across_axis(r);
  const double o = r.origin.z, d = r.direction.z;
  if (!(dot(flat.direction, flat.direction) > 0x1p-12 * d * d)) return {};
  const Glance tube = glance_at(Sphere{}, flat);
  if (tube.verdict != Glance::Verdict::passes) return tube;
  const bool is_level = d == 0;
  if (!is_level && !(std::fabs(d) > r.spread)) return {};

  double blur = tube.blur * 0x1p6;
  const double off = 2 * (blur * std::fabs(d) + 0x1p-22), low = c.z_min - off, high = c.z_max + off;
  const double z_enter = o + tube.enter * d, z_leave = o + tube.leave * d;
  if ((z_enter < low && z_leave < low) || (z_enter > high && z_leave > high)) return Glance::missing();
  const auto is_between = [&](double z) { return z > c.z_min + off && z < c.z_max - off; };
  const bool enters_side = is_between(z_enter), leaves_side = is_between(z_leave);
  if (enters_side && leaves_side) return Glance::passing(tube.enter, tube.leave, blur);
  const auto is_beyond = [&](double z) { return z < low || z > high; };
  if (!(enters_side || is_beyond(z_enter)) || !(leaves_side || is_beyond(z_leave))) return {};
  blur = greatest(blur, 0x1p-22 / std::fabs(d));
  const double near = d > 0 ? c.z_min : c.z_max, far = d > 0 ? c.z_max : c.z_min;
  return Glance::passing(enters_side ? tube.enter : (near - o) / d, leaves_side ? tube.leave : (far - o) / d,
                         blur);
}

/// Whether a point of the surface lies on a cap rather than on the side: nearer to a cap's plane than to the
/// tube.
inline bool is_on_cap(const Cylinder& c, const Vec3d& p) {
  const double side = std::fabs(p.x * p.x + p.y * p.y - 1) / 2;
  return least(std::fabs(p.z - c.z_min), std::fabs(p.z - c.z_max)) < side;
}

/// On the side the tube's far root is known; on a cap the slab's far plane is, as the slab's near one lies behind.
inline Bounded<double> exit_from_surface(const Cylinder& c, const LocalRay<double>& r) {
  const LocalRay<double> flat = across_axis(r);
  Interval<double> tube = tube_interval(r);
  if (!is_on_cap(c, r.origin) && max_abs(flat.direction) > r.spread)
    tube.leave = exit_from_surface(Sphere{}, flat);
  return intersection(tube, slab_interval(r, 2, c.z_min, c.z_max)).leave;
}

inline SurfacePoint surface_of(const Cylinder& c, const LocalRay<double>& r, double t, bool entering) {
  const Interval<double> tube = tube_interval(r);
  const Interval<double> slab = slab_interval(r, 2, c.z_min, c.z_max);
  const bool on_cap = entering ? slab.enter.t > tube.enter.t : slab.leave.t < tube.leave.t;
  Vec3d p = r.origin + r.direction * t;
  if (on_cap) {
    const bool high = (r.direction.z > 0) != entering;
    return {{p.x, p.y, high ? c.z_max : c.z_min}, {0, 0, high ? 1.0 : -1.0}};
  }
  const Vec3d side = surface_of(Sphere{}, across_axis(r), t, entering).point;
  return {{side.x, side.y, p.z}, {side.x, side.y, 0}};
}

/// u runs around the axis on the side and is 0 on the caps; v = z.
inline TextureCoordinates texture_of(const Cylinder&, const SurfacePoint& s) {
  return {s.normal.z != 0 ? 0 : deterministic::atan2(s.point.y, s.point.x) / (2 * pi) + 0.5, s.point.z};
}

inline Extent extent_of(const Cylinder& c, const Vec3d& row) {
  const double across = std::sqrt(row.x * row.x + row.y * row.y);
  if (row.z == 0) return about_zero(across);
  const double a = row.z * c.z_min, b = row.z * c.z_max;
  return {least(a, b) - across, greatest(a, b) + across};
}
inline double size_of(const Cylinder& c) {
  const double z = greatest(std::fabs(c.z_min), std::fabs(c.z_max));
  return z < infinity ? greatest(z, 1) : 1.0;
}

}  // namespace rayfarm
