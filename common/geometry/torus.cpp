#include "common/geometry/torus.h"

#include <cmath>
#include <span>

#include "common/geometry/cubic.h"
#include "common/geometry/sphere.h"
#include "common/geometry/torus_line.h"

namespace rayfarm {
namespace {

template <class T>
T square(T x) {
  return x * x;
}

/// f = (rho - R)^2 + z^2 - r^2, for a spindle torus times the same of rho + R: negative inside.
template <class T>
struct Sample {
  T u, f, error;
  T rho, rho_slope;  // distance from the axis; times df/du, which spares a division
  T bend;            // bound on rho |d2f/du2|
  bool is_uncertain() const {
    using std::fabs;
    return fabs(f) <= error;
  }
};

/// Of f's factors, for q = rho -+ R.
template <class T>
struct Factor {
  T f, error, rho_slope;
};

/// With p off by m a coordinate, f is off by 2 (|q| + |z|) m + 2 m^2, and by the roundings of its own terms.
template <class T>
Sample<T> sample(const TorusLine<T>& l, T u) {
  using std::fabs, std::sqrt;
  constexpr double roundoff = unit_roundoff_of<T>;
  const Vec3<T> p = l.foot + l.along * u;
  const T rho = sqrt(p.x * p.x + p.y * p.y);
  const T half_slope = p.x * l.along.x + p.y * l.along.y, rise = rho * p.z * l.along.z;
  const T moved = T(1.5) * (l.foot_error + fabs(u) * l.spread) + T(6 * roundoff);
  const auto factor = [&](T q) -> Factor<T> {
    return {(q - l.r) * (q + l.r) + p.z * p.z,
            T(2) * (fabs(q) + fabs(p.z) + moved) * moved + T(4 * roundoff) * (l.r * l.r),
            T(2) * (q * half_slope + rise)};
  };
  const T q = rho - l.R, bend = T(2) * (rho + fabs(q));
  const Factor<T> ring = factor(q);
  if (l.R >= l.r) return {u, ring.f, ring.error, rho, ring.rho_slope, bend};
  const Factor<T> lemon = factor(rho + l.R);
  const T error = fabs(ring.f) * lemon.error + (fabs(lemon.f) + lemon.error) * ring.error;
  return {u, ring.f * lemon.f, error, rho, ring.rho_slope * lemon.f + ring.f * lemon.rho_slope, T(12)};
}

/// The quartic f times the positive factor it lacks is u^4 + 2 p u^2 + 4 q u + its value at 0.
template <class T>
struct CriticalPoints {
  T p, q;
  int count = 0;
  T u[3];
};

/// Where the quartic f's line is stationary, between low and high, ascending: zeros of u^3 + p u + q. The two others
/// follow from the outermost.
template <class T>
CriticalPoints<T> critical_points(const TorusLine<T>& l) {
  using std::fabs, std::sqrt;
  const T RR = T(2) * l.R * l.R;
  const T p =
      dot(l.foot, l.foot) + (l.R - l.r) * (l.R + l.r) - RR * (l.along.x * l.along.x + l.along.y * l.along.y);
  const T q = -RR * (l.foot.x * l.along.x + l.foot.y * l.along.y);
  CriticalPoints<T> found{p, q, 0, {}};
  const auto add = [&](T u) {
    if (u > l.low && u < l.high) found.u[found.count++] = u;
  };
  const bool is_even = !(fabs(q) > T(0x1p-150));  // what is less moves no zero by more than 2^-50
  const T x = is_even ? sqrt(greatest(-p, T(0))) : outer_zero(p, fabs(q));
  const T outer = with_sign_of(x, -q), rest = T(-3) * x * x - T(4) * p;
  if (!(rest > T(0))) return add(outer), found;
  const T root = sqrt(rest);
  if (outer < T(0)) add(outer);
  add((-outer - root) / T(2)), add((-outer + root) / T(2));
  if (!(outer < T(0))) add(outer);
  return found;
}

/// A stationary point inside and one (or an end) outside: between them is one zero.
template <class T>
struct Bracket {
  const Sample<T>* inside;
  T outside;
};

/// About a stationary point s the quartic is f(s) + v^2 (A + B v + v^2), A = 6 s^2 + 2 p, B = 4 s; towards `outside`.
template <class T>
struct Rise {
  T deep, A, B, limit;
  T v;    // where that is zero, nearly
  T way;  // 1 or -1
};

template <class T>
Rise<T> rise_in(const TorusLine<T>& l, T p, const Bracket<T>& bracket) {
  using std::fabs, std::sqrt;
  const Sample<T>& inside = *bracket.inside;
  const T sum = inside.rho + l.R, lemon = (sum - l.r) * (sum + l.r) + square(l.foot.z + l.along.z * inside.u);
  const T s = inside.u;
  Rise<T> rise;
  rise.deep = l.R >= l.r ? -inside.f * lemon : -inside.f;
  rise.way = with_sign_of(T(1), bracket.outside - s);
  rise.A = T(6) * s * s + T(2) * p, rise.B = T(4) * s * rise.way;
  rise.limit = fabs(bracket.outside - s);
  rise.v = least(T(0.9) * rise.limit, sqrt(rise.deep / rise.A));  // A may be too small
  return rise;
}

/// A step of Halley's, which cubes what is left.
template <class T>
T closer(const Rise<T>& r) {
  const T v = r.v, g = (r.A + (r.B + v) * v) * v * v - r.deep;
  const T slope = (T(2) * r.A + (T(3) * r.B + T(4) * v) * v) * v;
  const T next = v - g * slope / (slope * slope - g * (r.A + (T(3) * r.B + T(6) * v) * v));
  return select(next > T(0) && next < r.limit, next, v);
}

/// Near the zeros in the brackets. A step is a division that waits for the one before, so all zeros take it together.
template <class T>
void guess_zeros(const TorusLine<T>& l, T p, std::span<const Bracket<T>> brackets, T* guesses) {
  const int steps = l.R >= l.r ? 2 : 3;  // of a spindle torus' f the last digits are dearer
  Rise<T> rises[4];
  for (std::size_t i = 0; i < brackets.size(); ++i) rises[i] = rise_in(l, p, brackets[i]);
  for (int step = 0; step < steps; ++step)
    for (std::size_t i = 0; i < brackets.size(); ++i) rises[i].v = closer(rises[i]);
  for (std::size_t i = 0; i < brackets.size(); ++i)
    guesses[i] = brackets[i].inside->u + rises[i].way * rises[i].v;
}

/// The zero in the bracket: Newton's steps, halving where they leave the bracket, until what a step leaves is less than
/// f's error.
template <class T>
Sample<T> zero_in(const TorusLine<T>& l, const Bracket<T>& bracket, T guess) {
  T negative = bracket.inside->u, positive = bracket.outside;
  Sample<T> s = sample(l, guess);
  for (int i = 0; i < 200; ++i) {
    const T step = s.f * s.rho / s.rho_slope, newton = s.u - step;
    const auto is_between = [&] {
      return newton > least(negative, positive) && newton < greatest(negative, positive);
    };
    if (s.bend * step * step <= s.error * s.rho && is_between()) {
      s.u = newton, s.f = s.error;
      break;
    }
    (s.f < T(0) ? negative : positive) = s.u;
    const T next = is_between() ? newton : (negative + positive) / T(2);
    if (next == s.u) break;
    s = sample(l, next);
  }
  return s;
}

Crossing crossing_within(double t, double error) { return {t, error}; }
Crossing crossing_within(const DoubleDouble& t, const DoubleDouble& error) {
  return crossing_at(rounded(bounded(t, error)));
}

template <class T>
Crossing crossing_of(const TorusLine<T>& l, T u, T u_error) {
  using std::fabs;
  constexpr double roundoff = unit_roundoff_of<T>;
  const T t = l.t_of_foot + u * l.t_per_u;
  const T error = l.t_error + (u_error + fabs(u) * l.spread) * l.t_per_u + T(2 * roundoff) * fabs(t);
  return crossing_within(t, error);
}

/// How far a stationary point within its error of zero can be from a crossing: sqrt(2 error / |f''|), at most
/// the distance to the nearer neighbour.
template <class T>
T tangent_reach(const TorusLine<T>& l, const Sample<T>& at, T limit) {
  using std::fabs, std::sqrt;
  const T step = limit / T(4);
  const Sample<T> before = sample(l, at.u - step), behind = sample(l, at.u + step);
  const T bend = fabs(behind.rho_slope / behind.rho - before.rho_slope / before.rho) / (T(2) * step);
  return bend > T(0) ? least(T(2) * sqrt(at.error / bend), limit) : limit;
}

/// The zero with what it may be off by.
template <class T>
Crossing crossing_of(const TorusLine<T>& l, const Sample<T>& zero, T limit) {
  using std::fabs;
  const T slope = fabs(zero.rho_slope), off = T(2) * (fabs(zero.f) + zero.error) * zero.rho;
  return crossing_of(l, zero.u, off < limit * slope ? off / slope : limit);
}

/// All crossings of the line beyond u = start, where it is inside or not, into `found`, ascending.
template <class T>
void add_crossings(const TorusLine<T>& l, T start, bool starts_inside, Crossings& found) {
  using std::fabs;
  std::array<Sample<T>, 5> knots;
  int n = 0;
  knots[n++] = {start, T(starts_inside ? -1 : 1), T(0), T(0), T(0), T(0)};
  const CriticalPoints<T> critical = critical_points(l);
  for (int i = 0; i < critical.count; ++i)
    if (critical.u[i] > start) knots[n++] = sample(l, critical.u[i]);
  knots[n++] = {l.high, T(1), T(0), T(0), T(0), T(0)};

  Bracket<T> brackets[4];
  T limits[4], guesses[4];
  std::size_t count = 0;
  int places[4];  // of the zeros among the crossings
  const Sample<T>* last = &knots[0];
  for (int i = 1; i < n; ++i) {
    const Sample<T>& knot = knots[i];
    const bool was_inside = last->f < T(0), is_inside = knot.f < T(0);
    if (i + 1 < n && knot.is_uncertain()) {
      found.wants_digits = true;
      if (was_inside == (knots[i + 1].f < T(0))) {
        const T limit = least(knot.u - last->u, knots[i + 1].u - knot.u);
        const Crossing tangent = crossing_of(l, knot.u, tangent_reach(l, knot, limit));
        found.add(tangent), found.add(tangent);
        continue;
      }
    }
    if (was_inside != is_inside) {
      brackets[count] = was_inside ? Bracket<T>{last, knot.u} : Bracket<T>{&knot, last->u};
      limits[count] = fabs(knot.u - last->u), places[count++] = found.count;
      found.add({});
    }
    last = &knot;
  }
  guess_zeros<T>(l, critical.p, {brackets, count}, guesses);
  for (std::size_t i = 0; i < count; ++i)
    found.at[static_cast<std::size_t>(places[i])] =
        crossing_of(l, zero_in(l, brackets[i], guesses[i]), limits[i]);
}

}  // namespace

template <class T>
Crossings crossings_of(const Torus& torus, const LocalRay<T>& ray) {
  TorusLine<T> l;
  Crossings line, found;
  if (!set_up(torus, ray, l)) return found;
  add_crossings(l, l.low, false, line);
  found.wants_digits = line.wants_digits;
  for (int i = 0; i < line.count; ++i) {
    const Crossing& c = line.at[static_cast<std::size_t>(i)];
    if (c.lo() <= 0 && c.hi() > 0) found.wants_digits = true;
    if (c.lo() <= 0)
      found.starts_inside = !found.starts_inside;
    else
      found.add(c);
  }
  return found;
}

template Crossings crossings_of(const Torus&, const LocalRay<double>&);
template Crossings crossings_of(const Torus&, const LocalRay<DoubleDouble>&);

Crossings crossings_from_surface(const Torus& torus, const LocalRay<double>& ray, bool inward) {
  TorusLine<double> l;
  Crossings found;
  if (!set_up(torus, ray, l)) return found;
  found.starts_inside = inward;
  add_crossings(l, least(greatest(-l.t_of_foot / l.t_per_u, l.low), l.high), inward, found);
  return found;
}
SurfacePoint surface_of(const Torus& torus, const LocalRay<double>& ray, double t, bool) {
  const Vec3d p = ray.origin + ray.direction * t;
  const double rho = std::sqrt(p.x * p.x + p.y * p.y);
  const Vec3d outward = rho > 0 ? Vec3d{p.x / rho, p.y / rho, 0} : Vec3d{1, 0, 0};
  const auto off = [&](double q) { return std::fabs((q - torus.r) * (q + torus.r) + p.z * p.z); };
  const bool on_lemon = off(rho + torus.R) < off(rho - torus.R);
  const Vec3d centre = outward * (on_lemon ? -torus.R : torus.R);
  const Vec3d spoke = normalized(p - centre);
  return {centre + spoke * torus.r, on_lemon ? -spoke : spoke};
}

TextureCoordinates texture_of(const Torus& torus, const SurfacePoint& s) {
  const Vec3d& p = s.point;
  // A point of a spindle torus' inner skin lies on the tube whose centre is across the axis.
  const double rho = std::sqrt(p.x * p.x + p.y * p.y), near = rho - torus.R, across = -(rho + torus.R);
  const auto off_tube = [&](double q) { return std::fabs(q * q + p.z * p.z - torus.r * torus.r); };
  return {deterministic::atan2(p.y, p.x) / (2 * pi) + 0.5,
          deterministic::atan2(off_tube(near) <= off_tube(across) ? near : across, p.z) / (2 * pi) + 0.5};
}

}  // namespace rayfarm
