// Quadrics as textbooks solve them, for comparison: A t^2 + 2 B t + C about the ray's own origin, or about the closest
// approach to the centre.
#pragma once
#include <cmath>

#include "common/math/vec.h"

namespace rayfarm::stability {

/// The two roots, when there are any; NaN otherwise, and in a comparison with it that is false.
template <class T>
struct Roots {
  bool real = false;
  T first{}, last{};
};

/// The signs of a quadric x^2 sx + y^2 sy + z^2 sz = rest.
template <class T>
struct Quadric {
  Vec3<T> signs;
  T rest;
};
template <class T>
constexpr Quadric<T> unit_sphere{{1, 1, 1}, 1};
template <class T>
constexpr Quadric<T> unit_tube{{1, 1, 0}, 1};
template <class T>
constexpr Quadric<T> unit_cone{{1, 1, -1}, 0};

/// (-B +- sqrt(B^2 - A C)) / A, as the original has it: a discriminant of 0 misses.
template <class T>
Roots<T> plain_roots(const Quadric<T>& q, const Vec3<T>& o, const Vec3<T>& d) {
  const T A = dot(d * q.signs, d), B = dot(o * q.signs, d), C = dot(o * q.signs, o) - q.rest;
  const T disc = B * B - A * C;
  if (!(disc > 0)) return {};
  const T root = std::sqrt(disc), a = (-B - root) / A, b = (-B + root) / A;
  return {true, std::min(a, b), std::max(a, b)};
}

/// The same without cancellation in the roots, which leaves that of the discriminant.
template <class T>
Roots<T> q_form_roots(const Quadric<T>& q, const Vec3<T>& o, const Vec3<T>& d) {
  const T A = dot(d * q.signs, d), B = dot(o * q.signs, d), C = dot(o * q.signs, o) - q.rest;
  const T disc = B * B - A * C;
  if (!(disc > 0)) return {};
  const T s = -(B + std::copysign(std::sqrt(disc), B)), a = s / A, b = C / s;
  return {true, std::min(a, b), std::max(a, b)};
}

/// The discriminant at the closest approach. Source: Ray Tracing Gems, chapter 7, 2019.
template <class T>
Roots<T> closest_approach_roots(const Vec3<T>& o, const Vec3<T>& d) {
  const T A = dot(d, d), B = dot(o, d);
  const Vec3<T> p = o - d * (B / A);
  const T disc = A * (T(1) - dot(p, p));
  if (!(disc > 0)) return {};
  const T s = -(B + std::copysign(std::sqrt(disc), B)), a = s / A, b = (dot(o, o) - T(1)) / s;
  return {true, std::min(a, b), std::max(a, b)};
}

template <class T>
Vec3<T> in(const Vec3d& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

}  // namespace rayfarm::stability
