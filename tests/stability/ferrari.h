// The torus as textbooks solve it, for comparison: the expanded quartic in closed form.
// Source: L. Ferrari's solution, as in M. Abramowitz and I. Stegun, Handbook of Mathematical Functions, 3.8.3.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/geometry/ray.h"
#include "common/geometry/solid.h"

namespace rayfarm::stability {

/// The real roots of x^4 + a x^3 + b x^2 + c x + d, ascending, into `roots`; how many.
inline int quartic_roots(double a, double b, double c, double d, double* roots) {
  const double p = b - 3 * a * a / 8, q = c - a * b / 2 + a * a * a / 8;
  const double r = d - a * c / 4 + a * a * b / 16 - 3 * a * a * a * a / 256;
  // One root of the resolvent y^3 - p/2 y^2 - r y + (4 r p - q^2) / 8.
  const double A = -p / 2, C = (4 * r * p - q * q) / 8, Q = (-3 * r - A * A) / 9;
  const double R = (-9 * A * r - 27 * C - 2 * A * A * A) / 54, D = Q * Q * Q + R * R;
  double y = -A / 3;
  if (D >= 0)
    y += std::cbrt(R + std::sqrt(D)) + std::cbrt(R - std::sqrt(D));
  else
    y += 2 * std::sqrt(-Q) * std::cos(std::acos(R / std::sqrt(-Q * Q * Q)) / 3);
  const double e = std::sqrt(std::max(2 * y - p, 0.0)),
               f = e > 0 ? q / (2 * e) : std::sqrt(std::max(y * y - r, 0.0));
  int count = 0;
  for (const auto& [half, rest] : {std::pair{-e / 2, y - f}, {e / 2, y + f}}) {
    const double disc = half * half - rest;
    if (!(disc > 0)) continue;
    roots[count++] = half - std::sqrt(disc) - a / 4, roots[count++] = half + std::sqrt(disc) - a / 4;
  }
  std::sort(roots, roots + count);
  return count;
}

/// Where the line meets the torus: t^4 + a t^3 + b t^2 + c t + d = 0, about the ray's own origin.
struct MonicQuartic {
  double a, b, c, d;
};
inline MonicQuartic torus_quartic(const Torus& torus, const Vec3d& o, const Vec3d& d) {
  const double dd = dot(d, d), od = dot(o, d), k = dot(o, o) + torus.R * torus.R - torus.r * torus.r;
  const double four = 4 * torus.R * torus.R, per = 1 / (dd * dd);
  return {4 * dd * od * per, (4 * od * od + 2 * dd * k - four * (d.x * d.x + d.y * d.y)) * per,
          (4 * od * k - 2 * four * (o.x * d.x + o.y * d.y)) * per,
          (k * k - four * (o.x * o.x + o.y * o.y)) * per};
}

inline int torus_roots(const Torus& torus, const Vec3d& o, const Vec3d& d, double* roots) {
  const MonicQuartic q = torus_quartic(torus, o, d);
  return quartic_roots(q.a, q.b, q.c, q.d, roots);
}

inline std::vector<double> ahead_of(const double* roots, int count, double shift) {
  std::vector<double> at;
  for (int i = 0; i < count; ++i)
    if (roots[i] + shift > 0) at.push_back(roots[i] + shift);
  return at;
}

template <class Shot>
std::vector<double> found_by_ferrari(const Shot& shot) {
  double roots[4];
  return ahead_of(roots, torus_roots(shot.torus, shot.ray.origin, shot.ray.direction, roots), 0);
}

/// From the closest approach on.
template <class Shot>
std::vector<double> found_by_shifted_ferrari(const Shot& shot) {
  const Vec3d &o = shot.ray.origin, &d = shot.ray.direction;
  const double shift = -dot(o, d) / dot(d, d);
  double roots[4];
  return ahead_of(roots, torus_roots(shot.torus, o + d * shift, d, roots), shift);
}

}  // namespace rayfarm::stability
