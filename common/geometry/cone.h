// The cone x^2 + y^2 < z^2 between z_min and z_max, its apex at the origin: two nappes, each convex.
//
// With p the line's closest approach to the apex, n its unit direction and g(s) = (x^2 + y^2 - z^2) / 2 at p + s n, a
// quarter of the discriminant of g is mx^2 + my^2 - mz^2, m = p x n: nothing cancels but at a tangent line. Sources:
// D. Eberly, Intersection of a Line and a Cone, Geometric Tools, 2000 (the nappes); the discriminant is Lagrange's
// identity in the metric (+, +, -).
#pragma once
#include "common/geometry/crossing.h"
#include "common/geometry/cube.h"
#include "common/geometry/ray.h"
#include "common/geometry/solid.h"
#include "common/geometry/sphere.h"
#include "common/geometry/surface_point.h"

namespace rayfarm {

template <class T>
T cone_metric(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y - a.z * b.z;
}

/// The line against the double cone: g(s) = (A s^2 + 2 B s + C) / 2 at p + s n.
template <class T>
struct ConeLine {
  ClosestApproach<T> c;
  Vec3<T> n;
  T n_error;  // of each coordinate of n
  T t_per_s;
  T A, A_error, B, C, C_error, disc, disc_error;
};

template <class T>
ConeLine<T> cone_line(const LocalRay<T>& ray) {
  using std::sqrt;
  constexpr double u = unit_roundoff_of<T>;
  ConeLine<T> l;
  l.c = closest_approach(ray);
  l.t_per_s = sqrt(l.c.inverse_dd);
  l.n = ray.direction * l.t_per_s;
  l.n_error = ray.spread * l.t_per_s + T(3 * u);
  const Vec3<T>&p = l.c.p, &n = l.n, m = cross(p, n);
  const T size = sum_abs(p);
  l.A = cone_metric(n, n), l.A_error = T(4) * l.n_error;
  l.B = cone_metric(p, n);
  l.C = cone_metric(p, p), l.C_error = T(2) * size * l.c.p_error + T(4 * u) * size * size;
  l.disc = m.x * m.x + m.y * m.y - m.z * m.z;
  const T m_error = T(2) * (l.c.p_error + size * l.n_error);
  l.disc_error = T(2) * sum_abs(m) * m_error + T(3) * m_error * m_error + T(4 * u) * size * size;
  return l;
}

template <class T>
Bounded<T> at(const ConeLine<T>& l, T s, T s_error) {
  using std::fabs;
  constexpr double u = unit_roundoff_of<T>;
  const T t = l.c.t + s * l.t_per_s;
  return bounded(t, l.c.t_error + s_error * l.t_per_s + T(4 * u) * fabs(l.c.t) +
                        (l.c.stretch + T(4 * u)) * fabs(s) * l.t_per_s);
}

/// A simple root: g's own error there over its slope, which is the root of the discriminant.
template <class T>
Bounded<T> root_at(const ConeLine<T>& l, T s, T slope) {
  using std::fabs;
  constexpr double u = unit_roundoff_of<T>;
  const T reach = fabs(s), size = sum_abs(l.c.p + l.n * s);
  const T g_error = size * (l.c.p_error + reach * (l.n_error + T(4 * u))) + T(4 * u) * size * size;
  return at(l, s, g_error / slope);
}

/// Where a line is inside the two nappes, in the line's order.
template <class T>
struct NappeIntervals {
  Interval<T> first, second;
};

template <class T>
NappeIntervals<T> from(const Bounded<T>& enter) {
  return {empty_interval<T>(), {enter, Interval<T>{}.leave}};
}
template <class T>
NappeIntervals<T> up_to(const Bounded<T>& leave) {
  return {{Interval<T>{}.enter, leave}, empty_interval<T>()};
}
template <class T>
NappeIntervals<T> up_to_and_from(const Bounded<T>& leave, const Bounded<T>& enter) {
  return {up_to(leave).first, from(enter).second};
}

/// The line touches the cone, passes its apex, or lies along a generator, all within the error.
template <class T>
NappeIntervals<T> tangent_intervals(const ConeLine<T>& l, const LocalRay<T>& ray) {
  using std::fabs, std::sqrt;
  NappeIntervals<T> none{empty_interval<T>(), empty_interval<T>()};
  none.first.wants_digits = true;
  if (fabs(l.A) > l.A_error) {
    if (l.disc < -l.disc_error && l.A > T(0)) return {empty_interval<T>(), empty_interval<T>()};
    const T half = sqrt(greatest(l.disc, T(0))) / fabs(l.A);
    const T reach = sqrt(T(2) * l.disc_error) / fabs(l.A) + l.c.p_error, middle = -l.B / l.A;
    const Bounded<T> low = at(l, middle - half, reach), high = at(l, middle + half, reach);
    if (l.A > T(0)) return {{low, high}, empty_interval<T>()};
    NappeIntervals<T> apex = up_to_and_from(low, high);
    apex.first.wants_digits = true;
    return apex;
  }
  if (l.C > l.C_error) return none;
  // A line in the surface counts as moved aside: then it is inside one nappe.
  const Bounded<T> apex = at(l, T(0), T(2) * l.c.p_error);
  NappeIntervals<T> along = cone_metric(ray.aside, l.n) < T(0) ? from(apex) : up_to(apex);
  along.first.wants_digits = true;
  return along;
}

template <class T>
NappeIntervals<T> nappe_intervals(const LocalRay<T>& ray) {
  using std::fabs, std::sqrt;
  const ConeLine<T> l = cone_line(ray);
  if (!(l.disc > l.disc_error)) return tangent_intervals(l, ray);
  const T root = sqrt(l.disc), q = l.B < T(0) ? root - l.B : -root - l.B;
  const Bounded<T> near = root_at(l, l.C / q, root);
  // Parallel to a generator, the far root is endlessly far.
  if (!(fabs(l.A) > l.A_error)) {
    NappeIntervals<T> parallel = l.B < T(0) ? from(near) : up_to(near);
    parallel.first.wants_digits = fabs(l.A) > T(0);
    return parallel;
  }
  const Bounded<T> far = root_at(l, q / l.A, root);
  const bool near_first = near.t < far.t;
  const Bounded<T>&first = near_first ? near : far, &last = near_first ? far : near;
  if (l.A < T(0)) return up_to_and_from(first, last);
  return {{first, last}, empty_interval<T>()};
}

/// The crossings ahead of the ray's origin.
template <class T>
Crossings crossings_of(const Cone& cone, const LocalRay<T>& ray) {
  const Interval<T> slab = slab_interval(ray, 2, T(cone.z_min), T(cone.z_max));
  const NappeIntervals<T> nappes = nappe_intervals(ray);
  const Interval<T> first = intersection(nappes.first, slab), second = intersection(nappes.second, slab);
  Crossings found = ahead(rounded(first));
  const Crossings later = ahead(rounded(second));
  found.starts_inside = found.starts_inside != later.starts_inside;
  for (int i = 0; i < later.count; ++i) found.add(later.at[static_cast<std::size_t>(i)]);
  found.wants_digits = first.is_in_doubt() || second.is_in_doubt();
  return found;
}

/// For a ray that starts on the cone: the crossing at the origin is known and left out.
Crossings crossings_from_surface(const Cone& cone, const LocalRay<double>& ray, bool inward);

SurfacePoint surface_of(const Cone& cone, const LocalRay<double>& ray, double t, bool entering);

/// u runs around the axis on the side and is 0 on the caps; v = z.
TextureCoordinates texture_of(const Cone& cone, const SurfacePoint& s);

Extent extent_of(const Cone& cone, const Vec3d& row);
double size_of(const Cone& cone);

}  // namespace rayfarm
