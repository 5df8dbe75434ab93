#include "common/math/deterministic.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "common/math/deterministic_tables.h"

namespace rayfarm::deterministic {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// c[0] + c[1] x + c[2] x^2 + ...
template <std::size_t N>
double polynomial(double x, const std::array<double, N>& c) {
  double sum = c[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + c[i];
  return sum;
}

// Circular functions. ---------------------------------------------------------------------------------------

/// An angle as quadrant * pi / 2 + rest, |rest| <= pi / 4 (and a little).
struct Reduced {
  int quadrant = 0;
  DoubleDouble rest;  // radians
};

Reduced reduced(double radians) {
  if (!std::isfinite(radians)) return {0, {std::numeric_limits<double>::quiet_NaN(), 0}};
  constexpr double exact_below = 1e9;
  if (std::fabs(radians) > exact_below) radians = std::fmod(radians, 2 * pi.hi);
  const double n = std::rint(radians * (2 / pi.hi));
  const double first =
      std::fma(-n, half_pi.hi, radians);  // exact: it cancels, and no bit is below the last of both
  const DoubleDouble second = two_product(n, half_pi.lo);
  return {static_cast<int>(static_cast<std::int64_t>(n) & 3),
          DoubleDouble{first, 0} - DoubleDouble{second.hi, second.lo + n * half_pi_3}};
}

Reduced reduced_deg(double degrees, double& rest_deg) {
  const double turn = std::fmod(degrees, 360.0), n = std::rint(turn / 90);
  rest_deg = turn - 90 * n;  // exact
  return {static_cast<int>(n) & 3, radians_per_degree * rest_deg};
}

/// Taylor series on |x| <= pi / 4: the first term left out is below 1e-19 of the sum.
DoubleDouble sine(const DoubleDouble& x) {
  constexpr std::array<double, 8> c{
      -1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
      -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
  const double z = x.hi * x.hi;
  return fast_two_sum(x.hi, x.hi * z * polynomial(z, c) + x.lo * (1 - z / 2));
}
DoubleDouble cosine(const DoubleDouble& x) {
  constexpr std::array<double, 8> c{
      1.0 / 24,        -1.0 / 720,         1.0 / 40320,          -1.0 / 3628800,
      1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000, -1.0 / 6402373705728000};
  const DoubleDouble z = two_product(x.hi, x.hi);
  const DoubleDouble lead = fast_two_sum(1, -z.hi / 2);
  return fast_two_sum(lead.hi, lead.lo + (z.hi * z.hi * polynomial(z.hi, c) - z.lo / 2 - x.hi * x.lo));
}

double sine_of(const Reduced& a) {
  const DoubleDouble s = a.quadrant & 1 ? cosine(a.rest) : sine(a.rest);
  return a.quadrant & 2 ? -s.hi : s.hi;
}
double tangent_of(const Reduced& a) {
  const DoubleDouble s = sine(a.rest), c = cosine(a.rest);
  return a.quadrant & 1 ? (-c / s).hi : (s / c).hi;
}
Reduced quarter_turn_on(Reduced a) {
  a.quadrant = (a.quadrant + 1) & 3;
  return a;
}

// Their inverses. -------------------------------------------------------------------------------------------

/// atan(y / x) for 0 <= y <= x, x > 0.
DoubleDouble angle_below_diagonal(DoubleDouble y, DoubleDouble x) {
  constexpr double tiny = 0x1p-60;  // atan(q) = q in double precision, long before
  if (y.hi / x.hi < tiny) return {y.hi / x.hi, 0};
  const int scale = -std::ilogb(x.hi);
  y = {std::ldexp(y.hi, scale), std::ldexp(y.lo, scale)};
  x = {std::ldexp(x.hi, scale), std::ldexp(x.lo, scale)};

  // atan(q) = atan(c) + atan((q - c) / (1 + q c)) with c a multiple of 1/16.
  const double steps = std::rint(16 * (y.hi / x.hi)), c = steps / 16;
  const DoubleDouble t = (y - x * c) / (x + y * c);
  constexpr std::array<double, 6> series{-1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13};
  const double z = t.hi * t.hi;
  return atan_table[static_cast<std::size_t>(steps)] +
         fast_two_sum(t.hi, t.lo + t.hi * z * polynomial(z, series));
}

/// The angle of the point (x, y) in the first quadrant, not the origin.
DoubleDouble angle(const DoubleDouble& y, const DoubleDouble& x) {
  return y.hi <= x.hi ? angle_below_diagonal(y, x) : half_pi - angle_below_diagonal(x, y);
}

/// sqrt(1 - x^2), |x| <= 1.
DoubleDouble other_leg(double x) {
  const DoubleDouble square = DoubleDouble{1, 0} - two_product(x, x);
  const double root = std::sqrt(square.hi);
  if (root == 0) return {0, 0};
  return fast_two_sum(root, (std::fma(-root, root, square.hi) + square.lo) / (2 * root));
}

// Exponential and logarithm. --------------------------------------------------------------------------------

/// exp(hi + lo); overflow and underflow as C's exp.
double exp_of(const DoubleDouble& x) {
  if (x.hi > 710) return infinity;
  if (x.hi < -746) return 0;
  const double k = std::rint(x.hi * per_ln_2.hi);
  const DoubleDouble r = DoubleDouble{std::fma(-k, ln_2.hi, x.hi), x.lo} - two_product(k, ln_2.lo);
  // |r| <= 0.35: the first term left out, r^15 / 15!, is below 1e-19.
  constexpr std::array<double, 13> c{1.0 / 2,          1.0 / 6,        1.0 / 24,        1.0 / 120,
                                     1.0 / 720,        1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                                     1.0 / 3628800,    1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800,
                                     1.0 / 87178291200};
  const double tail = r.hi * r.hi * polynomial(r.hi, c) + r.lo + r.hi * r.lo;
  const DoubleDouble lead = fast_two_sum(1, r.hi);
  return std::ldexp(lead.hi + (lead.lo + tail), static_cast<int>(k));
}

/// log(x) for finite x > 0, relative error below 2^-66.
DoubleDouble log_of(double x) {
  int k = 0;
  double m = std::frexp(x, &k);
  if (m < 0.70710678118654752) m *= 2, --k;  // now in [sqrt(1/2), sqrt(2))

  // log(m) = log(c) + 2 atanh((m - c) / (m + c)) with c a multiple of 1/32.
  const double steps = std::rint(32 * m), c = steps / 32;
  const DoubleDouble f = DoubleDouble{m - c, 0} / two_sum(m, c);
  constexpr std::array<double, 5> series{1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11};
  const double z = f.hi * f.hi;
  const DoubleDouble part = fast_two_sum(2 * f.hi, 2 * (f.lo + f.hi * z * polynomial(z, series)));
  return ln_2 * k + log_table[static_cast<std::size_t>(steps) - log_table_first] + part;
}

/// What log, log2 and log10 share: the special cases, then log_of(x) * unit.
double log_in(double x, const DoubleDouble& unit) {
  if (std::isnan(x) || x == infinity) return x;
  if (x == 0) return -infinity;
  if (x < 0) return nan;
  return (log_of(x) * unit).hi;
}

bool is_integer(double x) { return std::floor(x) == x; }
bool is_odd(double x) { return is_integer(x) && !is_integer(x / 2); }

}  // namespace

double sin(double radians) {
  if (radians == 0) return radians;
  return sine_of(reduced(radians));
}
double cos(double radians) { return sine_of(quarter_turn_on(reduced(radians))); }
double tan(double radians) {
  if (radians == 0) return radians;
  return tangent_of(reduced(radians));
}

double sin_deg(double degrees) {
  double rest = 0;
  const Reduced a = reduced_deg(degrees, rest);
  if (rest == 0 && !(a.quadrant & 1)) return std::copysign(0.0, degrees);
  if (std::fabs(rest) == 30 && !(a.quadrant & 1)) return (rest > 0) == (a.quadrant == 0) ? 0.5 : -0.5;
  return sine_of(a);
}
double cos_deg(double degrees) {
  double rest = 0;
  const Reduced a = quarter_turn_on(reduced_deg(degrees, rest));
  if (rest == 0 && !(a.quadrant & 1)) return 0;
  if (std::fabs(rest) == 30 && !(a.quadrant & 1)) return (rest > 0) == (a.quadrant == 0) ? 0.5 : -0.5;
  return sine_of(a);
}
double tan_deg(double degrees) {
  double rest = 0;
  const Reduced a = reduced_deg(degrees, rest);
  if (rest == 0) return sin_deg(degrees) / cos_deg(degrees);
  if (std::fabs(rest) == 45) return (rest > 0) == !(a.quadrant & 1) ? 1 : -1;
  return tangent_of(a);
}

double asin(double x) {
  if (!(std::fabs(x) <= 1)) return nan;
  return std::copysign(angle({std::fabs(x), 0}, other_leg(x)).hi, x);
}
double acos(double x) {
  if (!(std::fabs(x) <= 1)) return nan;
  const DoubleDouble acute = angle(other_leg(x), {std::fabs(x), 0});
  return x < 0 ? (pi - acute).hi : acute.hi;
}
double atan(double x) { return atan2(x, 1); }
double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return nan;
  const bool both_infinite = std::isinf(x) && std::isinf(y);
  const bool both_zero = x == 0 && y == 0;
  const double width = both_infinite ? 1 : both_zero ? 1 : std::fabs(x);
  const double height = both_infinite ? 1 : std::fabs(y);
  const DoubleDouble acute = angle({height, 0}, {width, 0});
  return std::copysign(std::signbit(x) ? (pi - acute).hi : acute.hi, y);
}

double exp(double x) {
  if (std::isnan(x)) return x;
  return exp_of({x, 0});
}
double log(double x) { return log_in(x, {1, 0}); }
double log2(double x) { return log_in(x, per_ln_2); }
double log10(double x) { return log_in(x, per_ln_10); }

double pow(double base, double exponent) {
  if (exponent == 0 || base == 1) return 1;
  if (std::isnan(base) || std::isnan(exponent)) return nan;
  const double size = std::fabs(base);
  if (std::isinf(exponent)) {
    if (size == 1) return 1;
    return (size > 1) == (exponent > 0) ? infinity : 0;
  }
  if (base < 0 && std::isfinite(base) && !is_integer(exponent)) return nan;
  const double sign = std::signbit(base) && is_odd(exponent) ? -1.0 : 1.0;
  if (size == 0 || std::isinf(size)) return sign * ((size == 0) == (exponent < 0) ? infinity : 0);

  const DoubleDouble log_size = log_of(size);
  if (log_size.hi * exponent > 710) return sign * infinity;
  if (log_size.hi * exponent < -746) return sign * 0.0;
  return sign * exp_of(log_size * exponent);
}

double integer_power(double base, unsigned n) {
  double result = 1;
  for (double square = base; n != 0; n >>= 1, square *= square)
    if (n & 1) result *= square;
  return result;
}

}  // namespace rayfarm::deterministic
