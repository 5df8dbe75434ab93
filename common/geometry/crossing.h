// Where a ray passes a solid's surface, with the bound that says how far off that may be.
//
// Two crossings whose intervals t +- error overlap are one simultaneous event. A grazing pair (in and out
// within its own error) is kept as an overlapping pair, so that a second copy of the surface finds it; alone
// it has no effect. Source: interval arithmetic on events as in A. A. G. Requicha and H. B. Voelcker, Boolean
// Operations in Solid Modeling, Proc. IEEE 73(1), 1985 (regularised set operations); running error analysis
// after Higham.
#pragma once
#include <array>
#include <cassert>
#include <cstdint>

#include "common/math/double_double.h"
#include "common/math/number.h"

namespace rayfarm {

struct Crossing {
  double t, error;
  double lo() const { return t - error; }
  double hi() const { return t + error; }
};

/// A value of t with its bounds: lo <= exact t <= hi.
template <class T>
struct Bounded {
  T t{}, lo{}, hi{};
};

/// Where a line is inside a convex solid; the whole line counts. Empty when enter.lo > leave.hi.
template <class T>
struct Interval {
  Bounded<T> enter{T(-infinity), T(-infinity), T(-infinity)};
  Bounded<T> leave{T(infinity), T(infinity), T(infinity)};
  bool wants_digits = false;  // rounding decided a side
  bool is_certain = false;    // the line passes through the solid, although its bounds overlap

  /// Whether it is empty, or on which side of an end the origin lies, when that matters: not when it is empty or behind
  /// for certain.
  bool is_in_doubt() const {
    const auto at_origin = [](const Bounded<T>& end) { return end.lo <= T(0) && end.hi > T(0); };
    if (wants_digits) return true;
    if (enter.lo > leave.hi || leave.hi <= T(0)) return false;
    return leave.lo <= enter.hi || at_origin(enter) || at_origin(leave);
  }
};

template <class T>
Interval<T> empty_interval() {
  return {{T(infinity), T(infinity), T(infinity)}, {T(-infinity), T(-infinity), T(-infinity)}};
}

template <class T>
Interval<T> intersection(const Interval<T>& a, const Interval<T>& b) {
  return {
      {greatest(a.enter.t, b.enter.t), greatest(a.enter.lo, b.enter.lo), greatest(a.enter.hi, b.enter.hi)},
      {least(a.leave.t, b.leave.t), least(a.leave.lo, b.leave.lo), least(a.leave.hi, b.leave.hi)},
      a.wants_digits || b.wants_digits};
}

template <class T>
Bounded<T> bounded(T t, T error) {
  return {t, t - error, t + error};
}

/// In double precision, its bounds widened by what that loses.
inline Bounded<double> rounded(const Bounded<DoubleDouble>& b) {
  constexpr double lost = gamma_bound(2);
  return {b.t.hi, b.lo.hi - lost * std::fabs(b.lo.hi), b.hi.hi + lost * std::fabs(b.hi.hi)};
}
inline Interval<double> rounded(const Interval<DoubleDouble>& i) {
  return {rounded(i.enter), rounded(i.leave), i.wants_digits, i.enter.t < i.leave.t};
}

inline Interval<double> rounded(const Interval<double>& i) { return i; }

/// Where a line is inside a convex solid, at a glance: what interval_of() says, to the bit, where its formulas tell
/// without their bounds. Those are all less than `blur` then, and so is no distance of two ends or of an end and the
/// ray's origin.
struct Glance {
  enum class Verdict : std::uint8_t { unsure, misses, passes };
  Verdict verdict = Verdict::unsure;
  double enter = 0, leave = 0, blur = 0;

  static Glance missing() { return {Verdict::misses}; }
  static Glance passing(double enter, double leave, double blur) {
    return {Verdict::passes, enter, leave, blur};
  }
};

/// Of a glance that tells nothing about the ray's origin yet.
[[gnu::always_inline]] inline Glance ahead(const Glance& g) {
  if (g.verdict != Glance::Verdict::passes) return g;
  if (g.leave < -g.blur) return Glance::missing();
  const bool is_sure = g.leave - g.enter > 2 * g.blur && g.leave > g.blur && std::fabs(g.enter) > g.blur;
  return is_sure ? g : Glance{};
}

inline Crossing crossing_at(const Bounded<double>& b) { return {b.t, greatest(b.t - b.lo, b.hi - b.t)}; }

/// The crossings ahead of the origin, ascending, in and out in turn, and the side at the origin.
struct Crossings {
  bool starts_inside = false;
  bool wants_digits = false;  // more of them would tell more
  int count = 0;
  std::array<Crossing, 8> at;

  void add(const Crossing& c) {
    assert(count < 8);
    at[static_cast<std::size_t>(count++)] = c;
  }
};

/// What of a convex solid lies ahead: a crossing that may be at or behind the origin has been passed.
inline Crossings ahead(const Interval<double>& i) {
  Crossings found;
  if (i.enter.lo > i.leave.hi || i.leave.lo <= 0) return found;
  if (i.enter.lo > 0)
    found.add(crossing_at(i.enter));
  else
    found.starts_inside = true;
  if (i.leave.t < infinity) found.add(crossing_at(i.leave));
  return found;
}

}  // namespace rayfarm
