#include "common/geometry/torus.h"

#include <cmath>

#include "common/geometry/sphere.h"

namespace rayfarm {
namespace {

/// The torus and the line in units of R + r, the line parametrised by length u from near its closest approach.
template <class T>
struct TorusLine {
  T R, r;                         // R + r = 1
  Vec3<T> foot, along;            // a point near the closest approach to the centre; unit direction
  T foot_error;                   // of each coordinate of foot
  T spread;                       // of each coordinate of along, and of its length
  T low, high;                    // outside of low < u < high the line is outside
  T t_of_foot, t_error, t_per_u;  // t = t_of_foot + u * t_per_u
};

template <class T>
T square(T x) {
  return x * x;
}

/// o + d t, rounded once.
double moved_along(double o, double d, double t) { return std::fma(d, t, o); }
DoubleDouble moved_along(const DoubleDouble& o, const DoubleDouble& d, const DoubleDouble& t) {
  return o + d * t;
}
template <class T>
Vec3<T> moved_along(const Vec3<T>& o, const Vec3<T>& d, T t) {
  return {moved_along(o.x, d.x, t), moved_along(o.y, d.y, t), moved_along(o.z, d.z, t)};
}

/// Cuts off what lies above or below the torus. False when nothing is left, or only what lies in its hole.
template <class T>
bool cut_to_bounds(TorusLine<T>& l, T slack) {
  using std::fabs;
  const T z = l.foot.z, dz = l.along.z, top = l.r + slack;
  const T rise = l.high * fabs(dz);  // low = -high
  if (fabs(z) > top + rise) return false;
  const T z_first = select(dz > T(0), z, -z);
  if (top + z_first < rise) l.low = -(top + z_first) / fabs(dz);
  if (top - z_first < rise) l.high = (top - z_first) / fabs(dz);
  const T hole = l.R - l.r - slack;
  const auto in_hole = [&](T u) {
    const T x = l.foot.x + l.along.x * u, y = l.foot.y + l.along.y * u;
    return hole > T(0) && x * x + y * y < hole * hole;
  };
  return !(in_hole(l.low) && in_hole(l.high));
}

/// False when the line misses the torus for certain. A line that runs from the ray's origin by t d has its foot
/// right to a few ulp of the foot itself, since o + t d is rounded once.
template <class T>
bool set_up(const Torus& torus, const LocalRay<T>& ray, TorusLine<T>& l) {
  using std::fabs, std::sqrt;
  constexpr double u = unit_roundoff_of<T>;
  const T unit = T(1) / (T(torus.R) + T(torus.r));
  const Vec3<T>&o = ray.origin, &d = ray.direction;
  const T inverse_dd = T(1) / dot(d, d);
  const T first = -(dot(o, d) * inverse_dd);
  const Vec3<T> rough = moved_along(o, d, first);
  const T second = -(dot(rough, d) * inverse_dd);
  const Vec3<T> foot = (rough + d * second) * unit;
  const T bb = dot(foot, foot), far = fabs(first);
  l.foot_error = (ray.origin_error + far * ray.direction_error) * unit + T(4 * u);
  const T slack = T(8) * l.foot_error;
  if (!(bb < T(1) + slack)) return false;

  const T length = sqrt(inverse_dd);
  l.R = T(torus.R) * unit, l.r = T(torus.r) * unit;
  l.foot = foot, l.along = d * length;
  l.spread = ray.spread * length + T(4 * u);
  l.high = sqrt(T(1) + slack - bb) + slack, l.low = -l.high;
  l.t_of_foot = first + second, l.t_per_u = length / unit;
  l.t_error = T(2 * u) * far + (l.foot_error + T(4 * u)) * l.t_per_u;
  return cut_to_bounds(l, slack + T(2) * l.spread);
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

/// Somewhere near the positive zero of x^3 + p x - q, q > 0: where there are three, within 2^-13 of it.
template <class T>
T near_outer_zero(T p, T q) {
  using std::sqrt;
  const T top = T(2);  // p and q are at most about 2
  if (!(p < T(0))) return p * top > q ? q / p : top;
  const T h = sqrt(-p / T(3)), fold = T(2) * h * h * h;
  if (q > T(8) * fold) return top;
  const T k = q / fold;
  if (k > T(1)) return least(h * (T(2) + (k - T(1)) * T(2.0 / 9)), top);
  // 2 cos(acos(k) / 3), interpolated.
  return h * (T(1.7321326590663837) +
              k * (T(0.3306607004416917) + k * (T(-0.0813823948457791) + k * T(0.018639367794966707))));
}

/// The positive zero of x^3 + p x - q, q > 0, of largest size, by Halley's steps.
template <class T>
T outer_zero(T p, T q) {
  using std::fabs;
  // A step cubes what is left, and f, which is stationary there, squares that.
  constexpr double enough = unit_roundoff_of < T >> 0x1p-60 ? 0x1p-10 : 0x1p-18;
  T x = near_outer_zero(p, q);
  for (int i = 0; i < 100; ++i) {
    const T g = (x * x + p) * x - q, slope = T(3) * x * x + p;
    const T step = g * slope / (slope * slope - T(3) * x * g);
    x = x - step;
    if (fabs(step) <= T(enough) * x) break;
  }
  return x;
}

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
  const T x = fabs(q) > T(0) ? outer_zero(p, fabs(q)) : sqrt(greatest(-p, T(0)));
  const T outer = q > T(0) ? -x : x, rest = T(-3) * x * x - T(4) * p;
  if (outer < T(0)) add(outer);
  if (rest > T(0)) {
    const T root = sqrt(rest);
    add((-outer - root) / T(2)), add((-outer + root) / T(2));
  }
  if (!(outer < T(0))) add(outer);
  return found;
}

/// About a stationary point s the quartic is f(s) + v^2 (A + B v + v^2), A = 6 s^2 + 2 p, B = 4 s: where that is zero.
template <class T>
T first_guess(const TorusLine<T>& l, T p, const Sample<T>& inside, T outside) {
  using std::fabs, std::sqrt;
  const T sum = inside.rho + l.R, lemon = (sum - l.r) * (sum + l.r) + square(l.foot.z + l.along.z * inside.u);
  const T deep = l.R >= l.r ? -inside.f * lemon : -inside.f;
  const T s = inside.u, A = T(6) * s * s + T(2) * p, B = outside > s ? T(4) * s : T(-4) * s;
  const T limit = outside > s ? outside - s : s - outside;
  T v = T(0.9) * limit;
  if (A * v * v > deep) v = sqrt(deep / A);
  for (int i = 0; i < 5; ++i) {  // Halley's, which cube what is left
    const T g = (A + (B + v) * v) * v * v - deep, slope = (T(2) * A + (T(3) * B + T(4) * v) * v) * v;
    const T next = v - g * slope / (slope * slope - g * (A + (T(3) * B + T(6) * v) * v));
    if (!(next > T(0) && next < limit)) break;
    const bool is_close = fabs(next - v) <= T(0x1p-8) * v;
    v = next;
    if (is_close) break;
  }
  return outside > s ? s + v : s - v;
}

/// The zero between a stationary point inside and one (or an end) outside: Newton's steps, halving where they leave
/// the bracket, until what a step leaves is less than f's error.
template <class T>
Sample<T> zero_between(const TorusLine<T>& l, T p, const Sample<T>& inside, T outside) {
  using std::fabs;
  T negative = inside.u, positive = outside;
  Sample<T> s = sample(l, first_guess(l, p, inside, outside));
  for (int i = 0; i < 200; ++i) {
    (s.f < T(0) ? negative : positive) = s.u;
    const T step = s.f * s.rho / s.rho_slope, newton = s.u - step;
    const bool within = newton > least(negative, positive) && newton < greatest(negative, positive);
    const T next = within ? newton : (negative + positive) / T(2);
    if (next == s.u) break;
    if (within && s.bend * step * step <= s.error * s.rho) {
      s.u = next, s.f = s.error;
      break;
    }
    s = sample(l, next);
  }
  return s;
}

Bounded<double> rounded(const Bounded<double>& b) { return b; }

template <class T>
Crossing crossing_of(const TorusLine<T>& l, T u, T u_error) {
  using std::fabs;
  constexpr double roundoff = unit_roundoff_of<T>;
  const T t = l.t_of_foot + u * l.t_per_u;
  const T error = l.t_error + (u_error + fabs(u) * l.spread) * l.t_per_u + T(2 * roundoff) * fabs(t);
  return crossing_at(rounded(bounded(t, error)));
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

  Sample<T> last = knots[0];
  for (int i = 1; i < n; ++i) {
    const Sample<T>& knot = knots[i];
    const bool was_inside = last.f < T(0), is_inside = knot.f < T(0);
    if (i + 1 < n && knot.is_uncertain()) {
      found.wants_digits = true;
      if (was_inside == (knots[i + 1].f < T(0))) {
        const T limit = least(knot.u - last.u, knots[i + 1].u - knot.u);
        const Crossing tangent = crossing_of(l, knot.u, tangent_reach(l, knot, limit));
        found.add(tangent), found.add(tangent);
        continue;
      }
    }
    if (was_inside != is_inside) {
      const T p = critical.p;
      const Sample<T> s = was_inside ? zero_between(l, p, last, knot.u) : zero_between(l, p, knot, last.u);
      const T limit = fabs(knot.u - last.u), slope = fabs(s.rho_slope);
      const T off = T(2) * (fabs(s.f) + s.error) * s.rho;
      found.add(crossing_of(l, s.u, off < limit * slope ? off / slope : limit));
    }
    last = knot;
  }
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
