// A line made ready to be met with a torus.
#pragma once
#include <cmath>

#include "common/geometry/ray.h"
#include "common/geometry/solid.h"
#include "common/math/double_double.h"
#include "common/math/number.h"

namespace rayfarm {

/// The torus and the line in units of R + r, the line parametrised by length u from near its closest approach.
template <class T>
struct TorusLine {
  T R, r;                         // R + r = 1
  Vec3<T> foot, along;            // a point near the closest approach to the centre; unit direction
  T foot_error;                   // of each coordinate of foot
  T spread;                       // of each coordinate of along, and of its length
  T low, high;                    // outside of low < u < high the line is outside
  T t_of_foot, t_error, t_per_u;  // t = t_of_foot + u * t_per_u
};

/// o + d t, rounded once.
inline double moved_along(double o, double d, double t) { return std::fma(d, t, o); }
inline DoubleDouble moved_along(const DoubleDouble& o, const DoubleDouble& d, const DoubleDouble& t) {
  return o + d * t;
}
template <class T>
Vec3<T> moved_along(const Vec3<T>& o, const Vec3<T>& d, T t) {
  return {moved_along(o.x, d.x, t), moved_along(o.y, d.y, t), moved_along(o.z, d.z, t)};
}

/// Cuts off what lies above or below the torus. False when nothing is left, or only what lies in its hole.
template <class T>
bool cut_to_bounds(TorusLine<T>& l, T slack) {
  using std::fabs;
  const T z = l.foot.z, dz = l.along.z, top = l.r + slack;
  const T rise = l.high * fabs(dz);  // low = -high
  if (fabs(z) > top + rise) return false;
  const T z_first = select(dz > T(0), z, -z);
  if (rise > T(0)) {  // without a further jump
    l.low = greatest(l.low, -(top + z_first) / fabs(dz));
    l.high = least(l.high, (top - z_first) / fabs(dz));
  }
  const T hole = l.R - l.r - slack;
  const auto in_hole = [&](T u) {
    const T x = l.foot.x + l.along.x * u, y = l.foot.y + l.along.y * u;
    return hole > T(0) && x * x + y * y < hole * hole;
  };
  return !(in_hole(l.low) && in_hole(l.high));
}

/// False when the line misses the torus for certain. A line that runs from the ray's origin by t d has its foot
/// right to a few ulp of the foot itself, since o + t d is rounded once.
template <class T>
bool set_up(const Torus& torus, const LocalRay<T>& ray, TorusLine<T>& l) {
  using std::fabs, std::sqrt;
  constexpr double u = unit_roundoff_of<T>;
  const T unit = T(1) / (T(torus.R) + T(torus.r));
  const Vec3<T>&o = ray.origin, &d = ray.direction;
  const T inverse_dd = T(1) / dot(d, d);
  const T first = -(dot(o, d) * inverse_dd);
  const Vec3<T> rough = moved_along(o, d, first);
  const T second = -(dot(rough, d) * inverse_dd);
  const Vec3<T> foot = (rough + d * second) * unit;
  const T bb = dot(foot, foot), far = fabs(first);
  l.foot_error = (ray.origin_error + far * ray.direction_error) * unit + T(4 * u);
  const T slack = T(8) * l.foot_error;
  if (!(bb < T(1) + slack)) return false;

  const T length = sqrt(inverse_dd);
  l.R = T(torus.R) * unit, l.r = T(torus.r) * unit;
  l.foot = foot, l.along = d * length;
  l.spread = ray.spread * length + T(4 * u);
  l.high = sqrt(T(1) + slack - bb) + slack, l.low = -l.high;
  l.t_of_foot = first + second, l.t_per_u = length / unit;
  l.t_error = T(2 * u) * far + (l.foot_error + T(4 * u)) * l.t_per_u;
  return cut_to_bounds(l, slack + T(2) * l.spread);
}

}  // namespace rayfarm
