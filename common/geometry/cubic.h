// The zero of a depressed cubic that the torus asks for.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

#include "common/math/double_double.h"
#include "common/math/number.h"

namespace rayfarm {

/// Within some 2^-5 of the cube root of a normal x > 0.
inline double near_cube_root(double x) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + 0x2a9f7893782da1ce);
}

/// Near the positive zero of x^3 - 3 m x - 2 h, h > 0, of largest size: within some 2^-12 of it, or of sqrt(|m|) if
/// that is more. Source: Cardano's formula; with three zeros, the trigonometric one.
inline double near_outer_zero(double m, double h) {
  const double disc = h * h - m * m * m;
  if (disc < 0) {
    const double root = std::sqrt(m), k = h / (m * root);
    // 2 cos(acos(k) / 3), interpolated.
    return root * (1.7321326590663837 +
                   k * (0.3306607004416917 + k * (-0.0813823948457791 + k * 0.018639367794966707)));
  }
  const double cube = h + std::sqrt(disc), rough = near_cube_root(cube), rough_cube = rough * rough * rough;
  const double w = rough * (rough_cube + 2 * cube) / (2 * rough_cube + cube);  // Halley's step
  return w + m / w;
}
inline double in_double(double x) { return x; }
inline double in_double(const DoubleDouble& x) { return x.hi; }

/// The positive zero of x^3 + p x - q, q > 2^-150, of largest size, by Halley's steps.
template <class T>
T outer_zero(T p, T q) {
  using std::fabs;
  // A step cubes what is left, and f, which is stationary there, squares that.
  constexpr double enough = unit_roundoff_of < T >> 0x1p-60 ? 0x1p-10 : 0x1p-18;
  T x = T(near_outer_zero(in_double(p) * (-1.0 / 3), in_double(q) / 2));
  for (int i = 0; i < 100; ++i) {
    const T g = (x * x + p) * x - q, slope = T(3) * x * x + p;
    const T step = g * slope / (slope * slope - T(3) * x * g);
    x = x - step;
    if (fabs(step) <= T(enough) * (x + fabs(p))) break;
  }
  return x;
}

}  // namespace rayfarm
