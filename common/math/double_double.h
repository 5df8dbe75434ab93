// A number as an unevaluated sum hi + lo of two doubles, |lo| <= ulp(hi) / 2: about 106 bits.
// Source: T. J. Dekker, A Floating-Point Technique for Extending the Available Precision, Numer. Math. 18,
// 1971.
#pragma once
#include <cmath>

#include "common/math/number.h"

namespace rayfarm {

struct DoubleDouble {
  double hi = 0, lo = 0;

  constexpr DoubleDouble() = default;
  constexpr explicit DoubleDouble(double value) : hi(value) {}
  constexpr DoubleDouble(double high, double low) : hi(high), lo(low) {}
  bool operator==(const DoubleDouble&) const = default;
};

/// a + b exactly.
inline DoubleDouble two_sum(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}
/// a + b exactly, for |a| >= |b|.
inline DoubleDouble fast_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}
/// a * b exactly, unless it underflows.
inline DoubleDouble two_product(double a, double b) {
  const double p = a * b;
  return {p, std::fma(a, b, -p)};
}
/// The relative error of these is a few 2^-105, of the sum that of cancelled terms beside.
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble s = two_sum(a.hi, b.hi);
  return fast_two_sum(s.hi, s.lo + (a.lo + b.lo));
}
inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
inline DoubleDouble operator*(const DoubleDouble& a, double b) {
  const DoubleDouble p = two_product(a.hi, b);
  return fast_two_sum(p.hi, p.lo + a.lo * b);
}
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = two_product(a.hi, b.hi);
  return fast_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double q = a.hi / b.hi;
  const double rest = std::fma(-q, b.hi, a.hi) + (a.lo - q * b.lo);
  return fast_two_sum(q, rest / b.hi);
}

// As a number type of geometry (number.h). No operation but a comparison may meet an infinity.

template <>
inline constexpr double unit_roundoff_of<DoubleDouble> = 0x1p-102;

inline bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
  return a.hi != b.hi ? a.hi < b.hi : a.lo < b.lo;
}
inline bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
inline bool operator<=(const DoubleDouble& a, const DoubleDouble& b) { return a < b || a == b; }
inline bool operator>=(const DoubleDouble& a, const DoubleDouble& b) { return b <= a; }
inline DoubleDouble fabs(const DoubleDouble& a) { return a.hi < 0 ? -a : a; }
inline DoubleDouble sqrt(const DoubleDouble& a) {
  const double root = std::sqrt(a.hi);
  if (root == 0) return {};
  const DoubleDouble rest = a - two_product(root, root);
  return fast_two_sum(root, rest.hi / (2 * root));
}
inline DoubleDouble with_sign_of(const DoubleDouble& size, const DoubleDouble& sign) {
  return std::signbit(sign.hi) ? -size : size;
}
inline DoubleDouble select(bool condition, const DoubleDouble& yes, const DoubleDouble& no) {
  return condition ? yes : no;
}
inline DoubleDouble least(const DoubleDouble& a, const DoubleDouble& b) { return b < a ? b : a; }
inline DoubleDouble greatest(const DoubleDouble& a, const DoubleDouble& b) { return a < b ? b : a; }

}  // namespace rayfarm
