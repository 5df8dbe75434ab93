#include "common/geometry/torus.h"

#include <cmath>

#include "common/geometry/sphere.h"

namespace rayfarm {
namespace {

/// The torus and the line in units of R + r, the line parametrised by length u from its closest approach.
struct Setting {
  double R, r;                // R + r = 1
  Vec3d foot, along;          // closest approach to the centre; unit direction
  double stretch;             // relative error of u, from the direction's
  double foot_error;          // of each coordinate of foot
  double reach;               // |u| <= reach: beyond it the line is outside
  double t_of_foot, t_error;  // t = t_of_foot + u * t_per_u
  double t_per_u;
};

struct Value {
  double f, error;
};

Vec3d at(const Setting& s, double u) { return s.foot + s.along * u; }

/// ((rho - R)^2 + z^2 - r^2) ((rho + R)^2 + z^2 - r^2): negative inside. The second factor is positive for
/// ring tori and is then left out.
Value implicit(const Setting& s, double u) {
  const Vec3d p = at(s, u);
  const double rho = std::sqrt(p.x * p.x + p.y * p.y);
  const double moved = s.foot_error + std::fabs(u) * s.stretch + 8 * unit_roundoff;  // of rho - R and of z
  const auto factor = [&](double q) {
    return Value{(q - s.r) * (q + s.r) + p.z * p.z, 2 * (std::fabs(q) + std::fabs(p.z)) * moved +
                                                        6 * unit_roundoff * s.r * s.r + 2 * moved * moved};
  };
  const Value ring = factor(rho - s.R);
  if (s.R >= s.r) return ring;
  const Value lemon = factor(rho + s.R);
  return {ring.f * lemon.f, std::fabs(ring.f) * lemon.error + std::fabs(lemon.f) * ring.error};
}

/// d implicit / du.
double slope(const Setting& s, double u) {
  const Vec3d p = at(s, u);
  const double rho = std::sqrt(p.x * p.x + p.y * p.y);
  const double rho_u = rho > 0 ? (p.x * s.along.x + p.y * s.along.y) / rho : 0;
  const auto factor = [&](double q) { return (q - s.r) * (q + s.r) + p.z * p.z; };
  const auto factor_u = [&](double q) { return 2 * (q * rho_u + p.z * s.along.z); };
  const double a = rho - s.R, b = rho + s.R;
  if (s.R >= s.r) return factor_u(a);
  return factor_u(a) * factor(b) + factor(a) * factor_u(b);
}

/// A zero of f between a and b, f(a) and f(b) of the given opposite signs: Newton steps, bisection where they
/// leave the bracket or do not halve it.
template <class F, class Derivative>
double zero_between(double a, double b, bool a_negative, F f, Derivative derivative) {
  double x = 0.5 * (a + b);
  for (int i = 0; i < 200; ++i) {
    const double fx = f(x);
    if (fx == 0) return x;
    ((fx < 0) == a_negative ? a : b) = x;
    const double newton = x - fx / derivative(x);
    const double middle = 0.5 * (a + b);
    const double next = newton > least(a, b) && newton < greatest(a, b) ? newton : middle;
    if (next == x || middle == a || middle == b) return next;
    // Newton closes in from one side; a step of a few ulp past it closes the bracket.
    x = next;
    if (std::fabs(next - a) + std::fabs(next - b) > 0.5 * std::fabs(b - a) && i % 3 == 2) x = middle;
  }
  return x;
}

struct CriticalPoints {
  int count = 0;
  double u[3];
};

/// Where the quartic is stationary: zeros of u^3 + p u + q with -reach < u < reach.
CriticalPoints critical_points(const Setting& s) {
  const double across = s.along.x * s.along.x + s.along.y * s.along.y;
  const double mixed = s.foot.x * s.along.x + s.foot.y * s.along.y;
  const double p = dot(s.foot, s.foot) + (s.R - s.r) * (s.R + s.r) - 2 * s.R * s.R * across;
  const double q = -2 * s.R * s.R * mixed;
  const auto cubic = [&](double u) { return (u * u + p) * u + q; };
  const auto cubic_u = [&](double u) { return 3 * u * u + p; };

  double ends[4] = {-s.reach, -s.reach, s.reach, s.reach};
  if (p < 0) {
    const double turn = std::sqrt(-p / 3);
    ends[1] = greatest(-turn, -s.reach), ends[2] = least(turn, s.reach);
  }
  CriticalPoints found;
  for (int i = 0; i < 3; ++i) {
    const double a = ends[i], b = ends[i + 1];
    if (!(a < b)) continue;
    const bool a_negative = cubic(a) < 0, b_negative = cubic(b) < 0;
    if (a_negative != b_negative) found.u[found.count++] = zero_between(a, b, a_negative, cubic, cubic_u);
  }
  return found;
}

bool set_up(const Torus& torus, const LocalRay<double>& ray, Setting& s) {
  const double unit = 1 / (torus.R + torus.r);
  const LocalRay<double> scaled{ray.origin * unit, ray.direction * unit,
                                ray.origin_error * unit + unit_roundoff * max_abs(ray.origin) * unit,
                                ray.direction_error * unit + unit_roundoff * max_abs(ray.direction) * unit};
  const ClosestApproach<double> c = closest_approach(scaled);
  const double bb = dot(c.p, c.p);
  const double slack = 8 * (c.p_error + unit_roundoff);  // outside for certain beyond 1 + slack
  if (bb > 1 + slack) return false;
  s = {torus.R * unit,
       torus.r * unit,
       c.p,
       scaled.direction * std::sqrt(c.inverse_dd),
       c.p_error,
       c.stretch,
       std::sqrt(1 + slack - bb) + slack,
       c.t,
       c.t_error,
       std::sqrt(c.inverse_dd)};
  return true;
}

struct Knot {  // an end of a monotone piece
  double u;
  Value value;
  bool negative() const { return value.f < 0; }
  bool is_uncertain() const { return std::fabs(value.f) <= value.error; }
};

Crossing crossing_of(const Setting& s, double u, double u_error) {
  const double t = s.t_of_foot + u * s.t_per_u;
  const double rounding =
      4 * unit_roundoff * std::fabs(s.t_of_foot) + (s.stretch + 4 * unit_roundoff) * std::fabs(u) * s.t_per_u;
  return {t, s.t_error + u_error * s.t_per_u + rounding};
}

/// How far a stationary point within its error of zero can be from a crossing: sqrt(2 error / |f''|), at most
/// the distance to the nearer neighbour.
double tangent_reach(const Setting& s, const Knot& knot, double limit) {
  const double step = 0.25 * limit;
  const double bend = std::fabs(slope(s, knot.u + step) - slope(s, knot.u - step)) / (2 * step);
  return bend > 0 ? least(2 * std::sqrt(knot.value.error / bend), limit) : limit;
}

Crossing crossing_between(const Setting& s, const Knot& a, const Knot& b) {
  const double u = zero_between(
      a.u, b.u, a.negative(), [&](double x) { return implicit(s, x).f; },
      [&](double x) { return slope(s, x); });
  const double steep = std::fabs(slope(s, u));
  const double limit = std::fabs(b.u - a.u);
  const double u_error = steep > 0 ? least(implicit(s, u).error / steep, limit) : limit;
  return crossing_of(s, u, u_error + 4 * unit_roundoff);
}

/// All crossings of the line beyond `start`, ascending. `start` is a point whose side is known.
struct Line {
  int count = 0;
  std::array<Crossing, 8> at;
};

Line line_crossings(const Setting& s, double start_u, bool start_inside) {
  std::array<Knot, 5> knots;
  int n = 0;
  knots[n++] = {start_u, {start_inside ? -1.0 : 1.0, 0}};
  const CriticalPoints critical = critical_points(s);
  for (int i = 0; i < critical.count; ++i)
    if (critical.u[i] > start_u) knots[n++] = {critical.u[i], implicit(s, critical.u[i])};
  knots[n++] = {s.reach, {1.0, 0}};

  Line line;
  const auto add = [&](const Crossing& c) { line.at[static_cast<std::size_t>(line.count++)] = c; };
  Knot last = knots[0];
  for (int i = 1; i < n; ++i) {
    const Knot& knot = knots[i];
    const bool stationary = i + 1 < n;
    if (stationary && knot.is_uncertain() && last.negative() == knots[i + 1].negative()) {
      const double limit = least(knot.u - last.u, knots[i + 1].u - knot.u);
      const Crossing tangent = crossing_of(s, knot.u, tangent_reach(s, knot, limit));
      add(tangent), add(tangent);
      continue;
    }
    if (knot.negative() != last.negative()) add(crossing_between(s, last, knot));
    last = knot;
  }
  return line;
}

}  // namespace

Crossings crossings_of(const Torus& torus, const LocalRay<double>& ray) {
  Setting s;
  Crossings found;
  if (!set_up(torus, ray, s)) return found;
  const Line line = line_crossings(s, -s.reach, false);
  for (int i = 0; i < line.count; ++i) {
    const Crossing& c = line.at[static_cast<std::size_t>(i)];
    if (c.lo() <= 0)
      found.starts_inside = !found.starts_inside;
    else
      found.add(c);
  }
  return found;
}

Crossings crossings_from_surface(const Torus& torus, const LocalRay<double>& ray, bool inward) {
  Setting s;
  Crossings found;
  found.starts_inside = inward;
  if (!set_up(torus, ray, s)) {
    found.starts_inside = false;
    return found;
  }
  const double start_u = least(-s.t_of_foot / s.t_per_u, s.reach);
  const Line line = line_crossings(s, start_u, inward);
  for (int i = 0; i < line.count; ++i) found.add(line.at[static_cast<std::size_t>(i)]);
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
