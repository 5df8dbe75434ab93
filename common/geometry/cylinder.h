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
          r.direction_error};
}

template <class T>
Interval<T> tube_interval(const LocalRay<T>& r) {
  const LocalRay<T> flat = across_axis(r);
  if (none(max_abs(flat.direction) > r.direction_error)) {
    // Within the error of the tube, the line counts as moved aside.
    const T outward = r.origin.x * r.aside.x + r.origin.y * r.aside.y;
    const T error = T(3) * r.origin_error + T(4 * unit_roundoff);
    const T oo = dot(flat.origin, flat.origin) + select(outward > T(0), error, -error);
    return oo < T(1) ? Interval<T>{} : empty_interval<T>();
  }
  return sphere_interval(flat);
}

template <class T>
Interval<T> cylinder_interval(const Cylinder& c, const LocalRay<T>& r) {
  return intersection(tube_interval(r), slab_interval(r, 2, T(c.z_min), T(c.z_max)));
}

/// For a ray that starts on the cylinder and goes inward. On the side the tube's far root is known; on a cap
/// the slab's far plane is, as the slab's near one lies behind.
inline Bounded<double> cylinder_exit_from_surface(const Cylinder& c, const LocalRay<double>& r, bool on_cap) {
  const LocalRay<double> flat = across_axis(r);
  Interval<double> tube = tube_interval(r);
  if (!on_cap && max_abs(flat.direction) > r.direction_error) tube.leave = sphere_exit_from_surface(flat);
  const Interval<double> slab = slab_interval(r, 2, c.z_min, c.z_max);
  return intersection(tube, slab).leave;
}

/// Whether a point of the surface lies on a cap rather than on the side: nearer to a cap's plane than to the
/// tube.
inline bool is_on_cap(const Cylinder& c, const Vec3d& p) {
  const double side = std::fabs(p.x * p.x + p.y * p.y - 1) / 2;
  return least(std::fabs(p.z - c.z_min), std::fabs(p.z - c.z_max)) < side;
}

inline SurfacePoint cylinder_surface(const Cylinder& c, const LocalRay<double>& r, double t, bool entering) {
  const Interval<double> tube = tube_interval(r);
  const Interval<double> slab = slab_interval(r, 2, c.z_min, c.z_max);
  const bool on_cap = entering ? slab.enter.t > tube.enter.t : slab.leave.t < tube.leave.t;
  Vec3d p = r.origin + r.direction * t;
  if (on_cap) {
    const bool high = (r.direction.z > 0) != entering;
    return {{p.x, p.y, high ? c.z_max : c.z_min}, {0, 0, high ? 1.0 : -1.0}};
  }
  const Vec3d side = sphere_surface(across_axis(r), entering).point;
  return {{side.x, side.y, p.z}, {side.x, side.y, 0}};
}

/// u runs around the axis on the side and is 0 on the caps; v = z.
inline TextureCoordinates cylinder_texture(const Vec3d& p, const Vec3d& n) {
  return {n.z != 0 ? 0 : deterministic::atan2(p.y, p.x) / (2 * pi) + 0.5, p.z};
}

}  // namespace rayfarm
