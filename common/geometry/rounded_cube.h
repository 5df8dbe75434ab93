// The cube [0,1]^3 with edges and corners rounded by the radius r: all that is within r of the core [r,1-r]^3.
//
// The core's planes cut a line into at most seven pieces. In each of them the solid is the cube, a tube along an edge of
// the core or a ball about its corner, so the line is inside from the first of these intervals to the last. Source: the
// solid is a Minkowski sum of a box and a ball, as in C. Ericson, Real-Time Collision Detection, 2005, section 5.5.7.
#pragma once
#include <array>

#include "common/geometry/cube.h"
#include "common/geometry/cylinder.h"
#include "common/geometry/solid.h"
#include "common/geometry/sphere.h"

namespace rayfarm {

/// The line in units of `radius` from `centre`, turned so that `axis` is z.
template <class T>
LocalRay<T> seen_from(const Vec3<T>& centre, T radius, int axis, const LocalRay<T>& ray) {
  constexpr double u = unit_roundoff_of<T>;
  const T per_radius = T(1) / radius;
  const auto turned = [&](const Vec3<T>& v) {
    return Vec3<T>{v[(axis + 1) % 3], v[(axis + 2) % 3], v[axis]};
  };
  LocalRay<T> seen;
  seen.origin = turned(ray.origin - centre) * per_radius, seen.direction = turned(ray.direction) * per_radius;
  seen.aside = turned(ray.aside);
  // Beside the ray's own errors those of 1 - r in the centre, of the difference, the quotient and the product.
  const T turn = T(3 * u) * max_abs(seen.direction);
  seen.origin_error = ray.origin_error * per_radius + T(4 * u) * (max_abs(seen.origin) + per_radius);
  seen.direction_error = ray.direction_error * per_radius + turn;
  seen.spread = ray.spread * per_radius + turn;
  return seen;
}

/// From the first to the last of two intervals of one line in one convex solid.
template <class T>
Interval<T> hull(const Interval<T>& a, const Interval<T>& b) {
  const auto is_empty = [](const Interval<T>& i) { return i.enter.lo > i.leave.hi; };
  const auto is_sure = [](const Interval<T>& i) { return i.enter.hi < i.leave.lo; };
  const auto is_there = [](const Interval<T>& i) { return i.enter.t < i.leave.t; };
  Interval<T> both = is_empty(b) || (is_there(a) && !is_empty(a)) ? a : b;
  both.wants_digits = a.wants_digits || b.wants_digits;
  if (is_empty(a) || is_empty(b)) return both;

  if (is_there(a) && is_there(b))
    both.enter.t = least(a.enter.t, b.enter.t), both.leave.t = greatest(a.leave.t, b.leave.t);
  both.enter.lo = least(a.enter.lo, b.enter.lo), both.leave.hi = greatest(a.leave.hi, b.leave.hi);
  // One that may not be there cannot say where the line is inside at the latest.
  if (is_sure(a) == is_sure(b)) {
    const bool sure = is_sure(a);
    both.enter.hi = sure ? least(a.enter.hi, b.enter.hi) : greatest(a.enter.hi, b.enter.hi);
    both.leave.lo = sure ? greatest(a.leave.lo, b.leave.lo) : least(a.leave.lo, b.leave.lo);
  } else {
    const Interval<T>& sure = is_sure(a) ? a : b;
    both.enter.hi = sure.enter.hi, both.leave.lo = sure.leave.lo;
  }
  return both;
}

/// Where a line passes the planes of the core.
template <class T>
struct CoreCuts {
  CoreCuts(const LocalRay<T>& ray, T low, T high) : side{low, high} {
    using std::fabs;
    at[count++] = Interval<T>{}.enter;
    for (int axis = 0; axis < 3; ++axis) {
      Interval<T>& slab = between[axis] = slab_interval(ray, axis, low, high);
      const bool is_cut = fabs(slab.enter.t) < T(infinity);
      is_rising[axis] = is_cut ? ray.direction[axis] > T(0) : passing_point(ray).p[axis] < T(0.5);
      if (is_cut) insert(slab.enter), insert(slab.leave);
    }
    at[count] = Interval<T>{}.leave;
  }

  Interval<T> piece(int number) const { return {at[number], at[number + 1]}; }

  int count = 0;  // of pieces
  Bounded<T> at[8];
  Interval<T> between[3];  // the planes of each axis
  bool is_rising[3];       // comes from the lower side
  T side[2];

 private:
  void insert(const Bounded<T>& cut) {
    int place = count++;
    for (; place > 1 && at[place - 1].t > cut.t; --place) at[place] = at[place - 1];
    at[place] = cut;
  }
};

/// Where the line is inside in one piece, but for the planes of the cube.
template <class T>
Interval<T> interval_in_piece(const CoreCuts<T>& cuts, int number, T radius, const LocalRay<T>& ray) {
  const Interval<T> piece = cuts.piece(number);
  Vec3<T> centre{};
  int beyond = 0, along = 2;  // axes along which it is beyond the core; the last one of the others
  for (int axis = 0; axis < 3; ++axis) {
    const bool before = cuts.between[axis].enter.t >= piece.leave.t;
    if (before || cuts.between[axis].leave.t <= piece.enter.t)
      ++beyond, centre[axis] = cuts.side[before != cuts.is_rising[axis]];
    else
      along = axis;
  }
  if (beyond < 2) return piece;
  const LocalRay<T> seen = seen_from(centre, radius, along, ray);
  return intersection(piece, beyond == 2 ? tube_interval(seen) : interval_of(Sphere{}, seen));
}

template <class T>
Interval<T> interval_of(const RoundedCube& cube, const LocalRay<T>& r) {
  // Where a cut is off by its error, so is, by as much, what the wrong piece takes for the surface.
  LocalRay<T> ray = r;
  ray.origin_error = T(2) * r.origin_error, ray.direction_error = T(2) * r.direction_error;
  ray.share = {T(1), T(1), T(1)};

  const Interval<T> in_cube = interval_of(Cube{}, ray);
  if (in_cube.enter.lo > in_cube.leave.hi) return in_cube;
  const CoreCuts<T> cuts(ray, T(cube.r), T(1) - T(cube.r));
  Interval<T> inside = empty_interval<T>();
  for (int i = 0; i < cuts.count; ++i) {
    const Interval<T> piece = intersection(in_cube, cuts.piece(i));
    if (piece.enter.lo > piece.leave.hi) continue;
    inside = hull(inside, intersection(in_cube, interval_in_piece(cuts, i, T(cube.r), ray)));
  }
  return inside;
}

inline Bounded<double> exit_from_surface(const RoundedCube& cube, const LocalRay<double>& ray) {
  return interval_of(cube, ray).leave;
}

inline SurfacePoint surface_of(const RoundedCube& cube, const LocalRay<double>& r, double t, bool) {
  constexpr Vec3d middle{0.5, 0.5, 0.5};
  LocalRay<double> about_middle = r;
  about_middle.origin = r.origin - middle;
  const ClosestApproach<double> c = closest_approach(about_middle);
  const Vec3d p = c.p + r.direction * (t - c.t) + middle;
  Vec3d nearest = p;  // of the core
  for (int i = 0; i < 3; ++i) nearest[i] = least(greatest(p[i], cube.r), 1 - cube.r);
  Vec3d out = p - nearest;
  if (out == Vec3d{}) {  // r is less than the rounding of p: towards the nearest face
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (std::fabs(p[i] - 0.5) > std::fabs(p[axis] - 0.5)) axis = i;
    out[axis] = p[axis] < 0.5 ? -1 : 1, nearest[axis] = p[axis] < 0.5 ? cube.r : 1 - cube.r;
  }
  const Vec3d normal = normalized(out * (1 / max_abs(out)));
  return {nearest + normal * cube.r, normal};
}

/// As on the cube's face to which the normal is nearest.
inline TextureCoordinates texture_of(const RoundedCube&, const SurfacePoint& s) {
  const Vec3d &p = s.point, n{std::fabs(s.normal.x), std::fabs(s.normal.y), std::fabs(s.normal.z)};
  if (n.x >= n.y && n.x >= n.z) return {p.y, p.z};
  return n.y >= n.z ? TextureCoordinates{p.x, p.z} : TextureCoordinates{p.x, p.y};
}

inline Extent extent_of(const RoundedCube& cube, const Vec3d& row) {
  const double out = cube.r * length(row);
  Extent e{-out, out};
  for (int i = 0; i < 3; ++i) {
    const double a = row[i] * cube.r, b = row[i] * (1 - cube.r);
    e.low += least(a, b), e.high += greatest(a, b);
  }
  return e;
}
inline double size_of(const RoundedCube&) { return 1; }

}  // namespace rayfarm
