// The unit sphere about the origin.
//
// The discriminant is taken at the line's closest approach to the centre: its error does not grow with the
// square of the distance. Source: E. Haines, J. Guenther, T. Akenine-Moeller, Precision Improvements for
// Ray/Sphere Intersection, Ray Tracing Gems, chapter 7, 2019.
#pragma once
#include "common/geometry/crossing.h"
#include "common/geometry/ray.h"
#include "common/geometry/solid.h"
#include "common/geometry/surface_point.h"
#include "common/math/deterministic.h"

namespace rayfarm {

/// The line's closest approach to the origin.
template <class T>
struct Foot {
  T t{};
  Vec3<T> p{};
  T inverse_dd{};  // 1 / dot(direction, direction)
};

template <class T>
[[gnu::always_inline]] inline Foot<T> foot_of(const Vec3<T>& o, const Vec3<T>& d) {
  const T inverse_dd = T(1) / dot(d, d);
  const T first = -(dot(o, d) * inverse_dd);
  const Vec3<T> rough = o + d * first;
  const T second = -(dot(rough, d) * inverse_dd);  // takes out what the first projection's rounding left
  return {first + second, rough + d * second, inverse_dd};
}

/// The same with error bounds.
template <class T>
struct ClosestApproach {
  T t{}, t_error{};
  Vec3<T> p{};
  T p_error{};     // of each coordinate
  T stretch{};     // bound on the relative error of lengths along the line, from the direction's
  T inverse_dd{};  // 1 / dot(direction, direction)
};

/// With u the unit roundoff: `rough` is off by at most 2u |o| + u |p| a coordinate, the second projection moves it
/// along the line only, so p is off by 6u max|o|, and t by as much along d. A direction that is off by e turns the
/// line about its origin: p by |t| e, t by |t| e |d|_1 / dd.
template <class T>
ClosestApproach<T> closest_approach(const LocalRay<T>& ray) {
  using std::fabs;
  constexpr double u = unit_roundoff_of<T>;
  const Vec3<T>&o = ray.origin, &d = ray.direction;
  const auto [t, p, inverse_dd] = foot_of(o, d);
  const T p_error = ray.origin_error + fabs(t) * ray.direction_error + T(6 * u) * max_abs(o);
  const T per_length = sum_abs(d) * inverse_dd, stretch = ray.spread * per_length;
  const T t_error = p_error * per_length + sum_abs(p) * ray.spread * inverse_dd + T(4 * u) * fabs(t);
  return {t, t_error, p, p_error, stretch, inverse_dd};
}

/// A line against the unit sphere: it is inside from t - half to t + half. Source of the discriminant: Lagrange's
/// identity, |o|^2 |d|^2 - (o d)^2 = |o x d|^2, which leaves nothing to cancel.
template <class T>
struct SphereLine {
  T inverse_dd{}, t{};
  T far{};  // squared distance from the centre
  T disc{};
};

template <class T>
[[gnu::always_inline]] inline SphereLine<T> sphere_line(const Vec3<T>& o, const Vec3<T>& d) {
  const T inverse_dd = T(1) / dot(d, d);
  const Vec3<T> m = cross(o, d);
  const T far = dot(m, m) * inverse_dd;
  return {inverse_dd, -(dot(o, d) * inverse_dd), far, T(1) - far};
}

/// Where the line is inside the unit sphere.
///
/// With u the unit roundoff: m / |d| is rounded by at most 2u |o| a coordinate, so the line passes within
/// M = sqrt(3) (e + |t| f) + 6u max|o| of where it seems to, disc is off by 2 M sqrt(far) + M^2 and its own roundings,
/// sqrt(far) at most (1 + far) / 2; t is off by |d|_1 / dd times e + |t| f + 6u max|o|, by what a
/// direction off by g turns, and by 6u |t|.
template <class T>
Interval<T> interval_of(const Sphere&, const LocalRay<T>& ray) {
  using std::fabs, std::sqrt;
  constexpr double u = unit_roundoff_of<T>;
  constexpr double root_3 = 1.7320508075688774;
  const SphereLine<T> l = sphere_line(ray.origin, ray.direction);
  const T moved = ray.origin_error + fabs(l.t) * ray.direction_error,
          rounding = T(6 * u) * max_abs(ray.origin);
  const T aside = T(root_3) * moved + rounding;
  const T disc_error = (aside + T(8 * u)) * (T(1) + l.far) + aside * aside;
  if (none(l.disc > -disc_error)) return empty_interval<T>();
  // Within its error of zero the line is tangent: an in-and-out pair that covers itself and any that the exact
  // discriminant, at most twice that error, has.
  const T half = sqrt(greatest(l.disc, T(0)) * l.inverse_dd);
  const T half_error =
      l.disc <= disc_error ? sqrt(T(2) * disc_error * l.inverse_dd) : disc_error * l.inverse_dd / half;
  const T per_length = sum_abs(ray.direction) * l.inverse_dd;
  const T turned = ray.spread * (T(root_3) * l.inverse_dd + per_length * half);
  const T error = (moved + rounding) * per_length + turned + half_error + T(6 * u) * (fabs(l.t) + half);
  return {bounded(l.t - half, error), bounded(l.t + half, error)};
}

/// A line that passes the sphere's edge by more than this, inward or outward as a difference of squared distances from
/// the centre, is far from grazing.
constexpr double clearly_off_edge = 0x1p-6;

/// With m the most that a ray at a glance is off by (Leaf::sure_size) and w = sqrt(disc) >= 1/8: t is off by at most
/// (sqrt(3) m + 2 sqrt(3) m / w + 5 m) / |d| < 2^5 m / (w |d|), and half is w / |d|.
[[gnu::always_inline]] inline Glance glance_at(const Sphere&, const LocalRay<double>& ray) {
  const SphereLine<double> l = sphere_line(ray.origin, ray.direction);
  if (l.far > 1 + clearly_off_edge) return Glance::missing();
  if (!(l.disc > clearly_off_edge)) return {};
  const double half = std::sqrt(l.disc * l.inverse_dd);
  return Glance::passing(l.t - half, l.t + half, half * 0x1p-20);
}

/// The crossing on the far side, for a ray that starts on the sphere and goes inward: the other root is
/// known.
template <class T>
Bounded<T> exit_from_surface(const Sphere&, const LocalRay<T>& ray) {
  const T dd = dot(ray.direction, ray.direction);
  const T t = greatest(T(-2) * dot(ray.origin, ray.direction) / dd, T(0));
  const ClosestApproach<T> c = closest_approach(ray);
  return bounded(t, T(2) * c.t_error);
}

/// The same at a glance: t is off by at most 2^4 m / |d|, m as above.
[[gnu::always_inline]] inline Glance exit_at_a_glance(const Sphere&, const LocalRay<double>& ray) {
  const double dd = dot(ray.direction, ray.direction);
  const double t = -2 * dot(ray.origin, ray.direction) / dd;
  return Glance::passing(-infinity, t, std::sqrt(1 / dd) * 0x1p-25);
}

inline SurfacePoint surface_of(const Sphere&, const LocalRay<double>& ray, double, bool entering) {
  const Foot<double> foot = foot_of(ray.origin, ray.direction);
  const double half = std::sqrt(greatest(1 - dot(foot.p, foot.p), 0) * foot.inverse_dd);
  const Vec3d p = normalized(foot.p + ray.direction * (entering ? -half : half));
  return {p, p};
}

constexpr double pi = 3.14159265358979323846;

/// u runs around the z axis, v from 0 at +z to 1 at -z.
inline TextureCoordinates texture_of(const Sphere&, const SurfacePoint& s) {
  const Vec3d& p = s.point;
  const double across = std::sqrt(p.x * p.x + p.y * p.y);
  const double u = across == 0 ? 0 : deterministic::atan2(p.y, p.x) / (2 * pi) + 0.5;
  return {u, deterministic::atan2(across, p.z) / pi};
}

inline Extent extent_of(const Sphere&, const Vec3d& row) { return about_zero(length(row)); }
inline double size_of(const Sphere&) { return 1; }

}  // namespace rayfarm
