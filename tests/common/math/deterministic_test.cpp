#include "common/math/deterministic.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>

namespace rayfarm {
namespace {

namespace d = deterministic;
using Real = long double;  // 64 bits of mantissa: its library functions are a good reference for 53
constexpr double inf = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

/// Error in units of the last place of the true value.
double ulps(double value, Real truth) {
  if (std::isnan(value) || std::isinf(value)) return value == static_cast<double>(truth) ? 0 : inf;
  const double near = static_cast<double>(truth);
  const double ulp = std::nextafter(std::fabs(near), inf) - std::fabs(near);
  return static_cast<double>(std::fabs((Real{value} - truth) / ulp));
}

double worst(std::function<double(double)> ours, std::function<Real(Real)> truth, double low, double high) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(low, high);
  double most = 0;
  for (int i = 0; i < 300'000; ++i) {
    const double x = any(random);
    most = std::max(most, ulps(ours(x), truth(x)));
  }
  return most;
}

TEST(Deterministic, CircularFunctionsAreWithinOneUlp) {
  for (const double range : {1e-3, 0.8, 10.0, 1e5}) {
    EXPECT_LT(worst(d::sin, sinl, -range, range), 1) << range;
    EXPECT_LT(worst(d::cos, cosl, -range, range), 1) << range;
    EXPECT_LT(worst(d::tan, tanl, -range, range), 1) << range;
  }
}

TEST(Deterministic, LargeAnglesAreReducedWithoutLoss) {
  EXPECT_LT(worst(d::sin, sinl, -1e9, 1e9), 1);
  EXPECT_LT(worst(d::cos, cosl, -1e9, 1e9), 1);
  // Next to a zero: the double nearest to 1e8 quarter turns.
  const double near_zero = 157079632.6794896541;
  EXPECT_NEAR(d::sin(near_zero), static_cast<double>(sinl(near_zero)), 1e-16);
  for (const double huge : {1e10, 1e100, 1e300}) EXPECT_LE(std::fabs(d::sin(huge)), 1);
}

TEST(Deterministic, InverseCircularFunctionsAreWithinOneUlp) {
  EXPECT_LT(worst(d::asin, asinl, -1, 1), 1);
  EXPECT_LT(worst(d::acos, acosl, -1, 1), 1);
  EXPECT_LT(worst(d::acos, acosl, 0.999999, 1), 1);
  for (const double range : {1e-5, 1.0, 100.0, 1e300})
    EXPECT_LT(worst(d::atan, atanl, -range, range), 1) << range;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 300'000; ++i) {
    const double y = std::ldexp(any(random), i % 600 - 300), x = std::ldexp(any(random), i % 37 * 16 - 300);
    ASSERT_LT(ulps(d::atan2(y, x), atan2l(y, x)), 1) << y << " " << x;
  }
}

TEST(Deterministic, ExponentialsAndLogarithmsAreWithinOneUlp) {
  EXPECT_LT(worst(d::exp, expl, -1, 1), 1);
  EXPECT_LT(worst(d::exp, expl, -708, 709), 1);
  for (const double range : {1.0, 2.0, 1e10, 1e300}) {
    EXPECT_LT(worst(d::log, logl, 1 / range / 2, range), 1) << range;
    EXPECT_LT(worst(d::log2, log2l, 1 / range / 2, range), 1) << range;
    EXPECT_LT(worst(d::log10, log10l, 1 / range / 2, range), 1) << range;
  }
  EXPECT_LT(worst(d::log, logl, 0.99999, 1.00001), 1);
}

TEST(Deterministic, PowersAreWithinOneUlp) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-1, 1), base(0.01, 100);
  for (int i = 0; i < 500'000; ++i) {
    const double b = base(random), e = any(random) * std::ldexp(1.0, i % 8);
    const Real truth = powl(b, e);
    if (truth > 1e300L || truth < 1e-300L) continue;
    // The reference itself is good to about 2^-64 relative to the exponent's size.
    ASSERT_LT(ulps(d::pow(b, e), truth), 1) << b << " " << e;
  }
}

TEST(Deterministic, PowersOfIntegersThatFitAreExact) {
  for (int b = -20; b <= 20; ++b)
    for (int e = 0; e <= 12; ++e) {
      double exact = 1;
      for (int i = 0; i < e; ++i) exact *= b;
      if (std::fabs(exact) > 9e15) continue;
      EXPECT_EQ(d::pow(b, e), exact) << b << "^" << e;
      EXPECT_EQ(d::integer_power(b, static_cast<unsigned>(e)), exact);
    }
  EXPECT_EQ(d::pow(2, -1074), std::ldexp(1.0, -1074));
  EXPECT_EQ(d::pow(2, 1023), std::ldexp(1.0, 1023));
  for (int k = -1074; k < 1024; ++k) EXPECT_EQ(d::log2(std::ldexp(1.0, k)), k);
  for (int k = 0; k <= 22; ++k) EXPECT_EQ(d::log10(d::integer_power(10, static_cast<unsigned>(k))), k);
}

TEST(Deterministic, DegreesAreExactAtMultiplesOfThirty) {
  const double sine[12] = {0, 0.5, nan, 1, nan, 0.5, 0, -0.5, nan, -1, nan, -0.5};  // nan: +-sqrt(3) / 2
  for (int k = -240; k <= 240; ++k) {
    const double wanted_sine = sine[(k % 12 + 12) % 12], wanted_cosine = sine[((k + 3) % 12 + 12) % 12];
    if (!std::isnan(wanted_sine)) {
      EXPECT_EQ(d::sin_deg(30.0 * k), wanted_sine) << 30 * k;
    }
    if (!std::isnan(wanted_cosine)) {
      EXPECT_EQ(d::cos_deg(30.0 * k), wanted_cosine) << 30 * k;
    }
  }
  for (int k = -20; k <= 20; ++k) {
    EXPECT_EQ(d::tan_deg(45 + 180.0 * k), 1);
    EXPECT_EQ(d::tan_deg(-45 + 180.0 * k), -1);
    EXPECT_EQ(d::tan_deg(180.0 * k), 0);
    EXPECT_FALSE(std::signbit(d::cos_deg(90 + 180.0 * k)));
  }
  EXPECT_EQ(d::tan_deg(90), inf);
  EXPECT_EQ(d::tan_deg(-90), -inf);
}

TEST(Deterministic, DegreesAreWithinOneUlp) {
  constexpr Real per_degree = 0.017453292519943295769236907684886127L;
  EXPECT_LT(worst(
                d::sin_deg, [](Real x) { return sinl(x * per_degree); }, -90, 90),
            1);
  EXPECT_LT(worst(
                d::tan_deg, [](Real x) { return tanl(x * per_degree); }, -89, 89),
            1);
  // A full turn changes nothing: the reduction is exact.
  for (int k = 1; k < 1000; ++k) EXPECT_EQ(d::cos_deg(0.25 * k + 360e6), d::cos_deg(0.25 * k));
}

TEST(Deterministic, SpecialCasesAnswerAsCDoes) {
  const double values[] = {0.0, -0.0,  1,      -1,     0.5,     -0.5, 2,    -2, 3,
                           -3,  1e300, -1e300, 5e-324, -5e-324, inf,  -inf, nan};
  const auto same = [](double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
  };
  for (const double y : values) {
    EXPECT_TRUE(same(d::log(y), std::log(y)) || std::fabs(y) > 1) << y;
    EXPECT_EQ(std::isnan(d::asin(y)), std::isnan(std::asin(y))) << y;
    EXPECT_EQ(std::isnan(d::sin(y)), std::isnan(std::sin(y))) << y;
    EXPECT_EQ(std::isnan(d::acos(y)), std::isnan(std::acos(y))) << y;
    for (const double x : values) {
      const double p = std::pow(y, x), a = std::atan2(y, x);
      EXPECT_TRUE(same(d::pow(y, x), p) || ulps(d::pow(y, x), p) <= 1)
          << y << "^" << x << " " << d::pow(y, x);
      EXPECT_TRUE(same(d::atan2(y, x), a) || ulps(d::atan2(y, x), a) <= 1)
          << y << ", " << x << " " << d::atan2(y, x);
    }
  }
  EXPECT_TRUE(std::signbit(d::sin(-0.0)) && std::signbit(d::tan(-0.0)) && std::signbit(d::atan(-0.0)));
  EXPECT_EQ(d::exp(-inf), 0);
  EXPECT_EQ(d::exp(inf), inf);
  EXPECT_EQ(d::exp(0), 1);
  EXPECT_EQ(d::exp(710), inf);
  EXPECT_EQ(d::exp(-746), 0);
  EXPECT_GT(d::exp(-745), 0);
}

TEST(Deterministic, TheBitsAreThoseOfEveryOtherBuild) {
  // A change of these is a change of every picture.
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  std::uint64_t hash = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double x = 0.001 * i * i - 700;
    for (const double y :
         {d::sin(x), d::cos(x), d::tan(x), d::exp(x / 10), d::log(x + 701), d::pow(x + 701, 0.37),
          d::atan2(x, i), d::asin(1.0 / i), d::acos(-1.0 / i), d::sin_deg(x), d::log10(x + 701)})
      hash = (hash ^ bits(y)) * 1099511628211u;
  }
  EXPECT_EQ(hash, 1341343227588874695u);
}

}  // namespace
}  // namespace rayfarm
