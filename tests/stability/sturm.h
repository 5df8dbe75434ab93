// The torus by Sturm's theorem: the quartic's real roots are counted in ever smaller intervals, then bracketed. What
// ray tracers offer where the closed form is not good enough.
// Source: D. G. Hook, P. R. McAree, Using Sturm Sequences to Bracket Real Roots of Polynomial Equations, Graphics Gems,
// 1990.
#pragma once
#include <array>

#include "tests/stability/ferrari.h"

namespace rayfarm::stability {

class SturmChain {
 public:
  explicit SturmChain(const MonicQuartic& q) {
    chain_[0] = {{q.d, q.c, q.b, q.a, 1}, 4};
    chain_[1] = {{q.c, 2 * q.b, 3 * q.a, 4, 0}, 3};
    for (count_ = 2; count_ < 5; ++count_) {
      chain_[count_] = minus_remainder(chain_[count_ - 2], chain_[count_ - 1]);
      if (chain_[count_].degree < 0) break;
      if (chain_[count_].degree == 0) {
        ++count_;
        break;
      }
    }
  }

  /// The roots in (low, high], ascending; one of even multiplicity counts once.
  void find(double low, double high, std::vector<double>& roots) const {
    const int inside = sign_changes(low) - sign_changes(high);
    const double middle = low + (high - low) / 2;
    const bool is_narrow = high - low <= 1e-12 * (std::fabs(low) + std::fabs(high));
    if (inside <= 0) return;
    if (inside == 1 && (value(0, low) < 0) != (value(0, high) < 0))
      return roots.push_back(bracketed(low, high));
    if (is_narrow || middle <= low || middle >= high) return roots.push_back(middle);
    find(low, middle, roots);
    find(middle, high, roots);
  }

 private:
  struct Polynomial {
    std::array<double, 5> by_power{};
    int degree = -1;  // of zero
  };

  /// Of a divided by b, scaled: only signs matter.
  static Polynomial minus_remainder(const Polynomial& a, const Polynomial& b) {
    std::array<double, 5> rest = a.by_power;
    for (int i = a.degree; i >= b.degree; --i) {
      const double share = rest[at(i)] / b.by_power[at(b.degree)];
      for (int k = 0; k <= b.degree; ++k) rest[at(i - b.degree + k)] -= share * b.by_power[at(k)];
    }
    constexpr double small_enough = 1e-12;  // is zero, as in the source
    Polynomial result;
    for (int i = b.degree - 1; i >= 0 && result.degree < 0; --i)
      if (std::fabs(rest[at(i)]) > small_enough) result.degree = i;
    for (int i = 0; i <= result.degree; ++i)
      result.by_power[at(i)] = -rest[at(i)] / std::fabs(rest[at(result.degree)]);
    return result;
  }
  static std::size_t at(int power) { return static_cast<std::size_t>(power); }

  double value(std::size_t number, double x) const {
    double v = 0;
    for (int i = chain_[number].degree; i >= 0; --i) v = v * x + chain_[number].by_power[at(i)];
    return v;
  }
  int sign_changes(double x) const {
    int changes = 0;
    double last = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double v = value(i, x);
      if (v == 0) continue;
      changes += v * last < 0;
      last = v < 0 ? -1 : 1;
    }
    return changes;
  }
  double bracketed(double low, double high) const {
    const bool is_negative = value(0, low) < 0;
    for (int i = 0; i < 100; ++i) {
      const double middle = low + (high - low) / 2;
      ((value(0, middle) < 0) == is_negative ? low : high) = middle;
    }
    return low + (high - low) / 2;
  }

  std::array<Polynomial, 5> chain_;
  std::size_t count_;
};

/// From the closest approach on.
template <class Shot>
std::vector<double> found_by_sturm(const Shot& shot) {
  const Vec3d &o = shot.ray.origin, &d = shot.ray.direction;
  const double shift = -dot(o, d) / dot(d, d), reach = 1.1 * (shot.torus.R + shot.torus.r) / length(d);
  std::vector<double> roots;
  SturmChain(torus_quartic(shot.torus, o + d * shift, d)).find(-reach, reach, roots);
  return ahead_of(roots.data(), static_cast<int>(roots.size()), shift);
}

}  // namespace rayfarm::stability
