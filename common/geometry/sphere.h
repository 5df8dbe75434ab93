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

/// The line's closest approach to the origin: at parameter t, point p; each with an error bound.
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
  const T inverse_dd = T(1) / dot(d, d);
  const T first = -(dot(o, d) * inverse_dd);
  const Vec3<T> rough = o + d * first;
  const T second = -(dot(rough, d) * inverse_dd);  // takes out what the first projection's rounding left
  const T t = first + second;
  const Vec3<T> p = rough + d * second;

  const T p_error = ray.origin_error + fabs(t) * ray.direction_error + T(6 * u) * max_abs(o);
  const T per_length = sum_abs(d) * inverse_dd, stretch = ray.spread * per_length;
  const T t_error = p_error * per_length + sum_abs(p) * ray.spread * inverse_dd + T(4 * u) * fabs(t);
  return {t, t_error, p, p_error, stretch, inverse_dd};
}

/// Where the line is inside the unit sphere, given its closest approach: sqrt(disc / dd) to both sides.
template <class T>
Interval<T> interval_about(const ClosestApproach<T>& c, T disc, T disc_error) {
  using std::fabs, std::sqrt;
  if (none(disc > -disc_error)) return empty_interval<T>();
  constexpr double u = unit_roundoff_of<T>;
  // Within its error of zero the line is tangent: an in-and-out pair that covers itself and any that the exact
  // discriminant, at most twice that error, has.
  const auto tangent = disc <= disc_error;
  const T root = sqrt(select(tangent, T(2) * disc_error, disc) * c.inverse_dd);
  const T half = select(tangent, sqrt(greatest(disc, T(0)) * c.inverse_dd), root);
  const T half_error = select(tangent, root, disc_error * c.inverse_dd / root);
  const T error = c.t_error + half_error + T(2 * u) * fabs(c.t) + (c.stretch + T(4 * u)) * half;
  return {bounded(c.t - half, error), bounded(c.t + half, error)};
}

template <class T>
Interval<T> interval_of(const Sphere&, const LocalRay<T>& ray) {
  const ClosestApproach<T> c = closest_approach(ray);
  const T pp = dot(c.p, c.p);
  const T disc_error = T(2) * sum_abs(c.p) * c.p_error + T(3) * c.p_error * c.p_error +
                       T(4 * unit_roundoff_of<T>) * (T(1) + pp);
  return interval_about(c, T(1) - pp, disc_error);
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

inline SurfacePoint surface_of(const Sphere&, const LocalRay<double>& ray, double, bool entering) {
  const ClosestApproach<double> c = closest_approach(ray);
  const double half = std::sqrt(greatest(1 - dot(c.p, c.p), 0) * c.inverse_dd);
  const Vec3d p = normalized(c.p + ray.direction * (entering ? -half : half));
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
