#include "common/geometry/cone.h"

#include <cmath>

namespace rayfarm {
namespace {

double metric(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y - a.z * b.z; }
double sum_abs(const Vec3d& a) { return std::fabs(a.x) + std::fabs(a.y) + std::fabs(a.z); }

/// The line against the double cone: g(s) = (A s^2 + 2 B s + C) / 2 at p + s n.
struct Setting {
  ClosestApproach<double> c;
  Vec3d n;
  double n_error;  // of each coordinate of n
  double t_per_s;
  double A, A_error, B, C, C_error, disc, disc_error;
};

Setting set_up(const LocalRay<double>& ray) {
  Setting s;
  s.c = closest_approach(ray);
  s.t_per_s = std::sqrt(s.c.inverse_dd);
  s.n = ray.direction * s.t_per_s;
  s.n_error = ray.direction_error * s.t_per_s + 3 * unit_roundoff;
  const Vec3d &p = s.c.p, &n = s.n, m = cross(p, n);
  const double size = sum_abs(p);
  s.A = metric(n, n), s.A_error = 4 * s.n_error;
  s.B = metric(p, n);
  s.C = metric(p, p), s.C_error = 2 * size * s.c.p_error + 4 * unit_roundoff * size * size;
  s.disc = m.x * m.x + m.y * m.y - m.z * m.z;
  const double m_error = 2 * (s.c.p_error + size * s.n_error);
  s.disc_error = 2 * sum_abs(m) * m_error + 3 * m_error * m_error + 4 * unit_roundoff * size * size;
  return s;
}

Bounded<double> at(const Setting& s, double where, double s_error) {
  const double t = s.c.t + where * s.t_per_s;
  return bounded(t, s.c.t_error + s_error * s.t_per_s + 4 * unit_roundoff * std::fabs(s.c.t) +
                        (s.c.stretch + 4 * unit_roundoff) * std::fabs(where) * s.t_per_s);
}

/// A simple root: g's own error there over its slope, which is the root of the discriminant.
Bounded<double> root_at(const Setting& s, double where, double slope) {
  const double reach = std::fabs(where), size = sum_abs(s.c.p + s.n * where);
  const double g_error =
      size * (s.c.p_error + reach * (s.n_error + 4 * unit_roundoff)) + 4 * unit_roundoff * size * size;
  return at(s, where, g_error / slope);
}

Interval<double> from(const Bounded<double>& enter) { return {enter, Interval<double>{}.leave}; }
Interval<double> up_to(const Bounded<double>& leave) { return {Interval<double>{}.enter, leave}; }

/// The line touches the cone, passes its apex, or lies along a generator, all within the error.
NappeIntervals tangent(const Setting& s, const LocalRay<double>& ray) {
  const Interval<double> none = empty_interval<double>();
  if (std::fabs(s.A) > s.A_error) {
    const Bounded<double> touch =
        at(s, -s.B / s.A, std::sqrt(2 * s.disc_error) / std::fabs(s.A) + std::fabs(s.c.p_error));
    if (s.A < 0) return {up_to(touch), from(touch)};
    return {s.disc < -s.disc_error ? none : Interval<double>{touch, touch}, none};
  }
  if (s.C > s.C_error) return {none, none};
  // A line in the surface counts as moved aside: then it is inside one nappe.
  const Bounded<double> apex = at(s, 0, 2 * s.c.p_error);
  return metric(ray.aside, s.n) < 0 ? NappeIntervals{none, from(apex)} : NappeIntervals{up_to(apex), none};
}

/// Nearer to a cap's plane than to the side.
bool is_on_cap(const Cone& cone, const Vec3d& p) {
  const double side = std::fabs(std::sqrt(p.x * p.x + p.y * p.y) - std::fabs(p.z)) * 0.7;
  return least(std::fabs(p.z - cone.z_min), std::fabs(p.z - cone.z_max)) < side;
}

}  // namespace

NappeIntervals nappe_intervals(const LocalRay<double>& ray) {
  const Setting s = set_up(ray);
  if (!(s.disc > s.disc_error)) return tangent(s, ray);
  const double root = std::sqrt(s.disc), q = -(s.B + std::copysign(root, s.B));
  const double near = s.C / q, far = q / s.A;
  if (!(std::fabs(s.A) > s.A_error)) {  // parallel to a generator: the far root is endlessly far
    const Bounded<double> only = root_at(s, near, root);
    const Interval<double> none = empty_interval<double>();
    return s.B < 0 ? NappeIntervals{none, from(only)} : NappeIntervals{up_to(only), none};
  }
  const Bounded<double> first = root_at(s, least(near, far), root),
                        last = root_at(s, greatest(near, far), root);
  if (s.A < 0) return {up_to(first), from(last)};
  return {Interval<double>{first, last}, empty_interval<double>()};
}

Crossings crossings_of(const Cone& cone, const LocalRay<double>& ray) {
  const Interval<double> slab = slab_interval(ray, 2, cone.z_min, cone.z_max);
  const NappeIntervals nappes = nappe_intervals(ray);
  Crossings found = ahead(intersection(nappes.first, slab));
  const Crossings second = ahead(intersection(nappes.second, slab));
  found.starts_inside = found.starts_inside != second.starts_inside;
  for (int i = 0; i < second.count; ++i) found.add(second.at[static_cast<std::size_t>(i)]);
  return found;
}

namespace {

/// The origin is in one of the nappes, which is left first.
Crossings inward_from_cap(const Interval<double>& slab, const NappeIntervals& nappes) {
  Crossings found;
  found.starts_inside = true;
  for (const Interval<double>& nappe :
       {intersection(nappes.first, slab), intersection(nappes.second, slab)}) {
    if (nappe.enter.lo > nappe.leave.hi || nappe.leave.t <= 0) continue;
    if (found.count > 0) found.add(crossing_at(nappe.enter));
    if (nappe.leave.t < infinity) found.add(crossing_at(nappe.leave));
  }
  if (found.count == 0) found.add({0, 0});  // along the rim
  return found;
}

/// The other root is known: t = -2 o.d / d.d in the cone's metric.
Crossings from_side(const Interval<double>& slab, const LocalRay<double>& ray, bool inward) {
  const double A = metric(ray.direction, ray.direction), B = metric(ray.origin, ray.direction);
  const double size = sum_abs(ray.direction), relative = ray.direction_error / size + 4 * unit_roundoff;
  Interval<double> onward;  // inside from here on, or from where the other nappe begins
  if (std::fabs(A) > 2 * relative * size * size) {
    const double t = greatest(-2 * B / A, 0);
    const double B_error = size * (ray.origin_error + max_abs(ray.origin) * relative * 2);
    const Bounded<double> other =
        bounded(t, 2 * (B_error + t * relative * size * size) / std::fabs(A) + 4 * unit_roundoff * t);
    if (inward && A > 0) onward.leave = other;
    if (!inward && A < 0) onward.enter = other;
  }
  Crossings found;
  found.starts_inside = inward;
  const Interval<double> rest = intersection(onward, slab);
  if (inward) {
    if (rest.leave.t < infinity) found.add(rest.leave.t > 0 ? crossing_at(rest.leave) : Crossing{0, 0});
  } else if (onward.enter.t > 0 && !(rest.enter.lo > rest.leave.hi)) {
    found.add(crossing_at(rest.enter));
    if (rest.leave.t < infinity) found.add(crossing_at(rest.leave));
  }
  return found;
}

}  // namespace

Crossings crossings_from_surface(const Cone& cone, const LocalRay<double>& ray, bool inward) {
  const Interval<double> slab = slab_interval(ray, 2, cone.z_min, cone.z_max);
  if (!is_on_cap(cone, ray.origin)) return from_side(slab, ray, inward);
  return inward ? inward_from_cap(slab, nappe_intervals(ray)) : Crossings{};
}

SurfacePoint surface_of(const Cone& cone, const LocalRay<double>& ray, double t, bool entering) {
  const ClosestApproach<double> c = closest_approach(ray);
  const Vec3d p = c.p + ray.direction * (t - c.t);
  if (is_on_cap(cone, p)) {
    const bool high = (ray.direction.z > 0) != entering;
    return {{p.x, p.y, high ? cone.z_max : cone.z_min}, {0, 0, high ? 1.0 : -1.0}};
  }
  const double rho = std::sqrt(p.x * p.x + p.y * p.y), r = (rho + std::fabs(p.z)) / 2;
  const double up = p.z < 0 ? -1 : 1;
  const Vec3d out = rho > 0 ? Vec3d{p.x / rho, p.y / rho, 0} : Vec3d{};
  return {{out.x * r, out.y * r, up * r}, {out.x, out.y, -up}};
}

TextureCoordinates texture_of(const Cone&, const SurfacePoint& s) {
  const bool on_cap = s.normal.x == 0 && s.normal.y == 0;
  return {on_cap ? 0 : deterministic::atan2(s.point.y, s.point.x) / (2 * pi) + 0.5, s.point.z};
}

Extent extent_of(const Cone& cone, const Vec3d& row) {
  const double across = std::sqrt(row.x * row.x + row.y * row.y);
  const bool has_apex = cone.z_min <= 0 && cone.z_max >= 0;
  Extent e = has_apex ? Extent{0, 0} : Extent{infinity, -infinity};
  for (const double z : {cone.z_min, cone.z_max})
    for (const double slope : {row.z - across, row.z + across}) {
      const double at = slope == 0 ? 0 : z * slope;
      e = {least(e.low, at), greatest(e.high, at)};
    }
  return e;
}

double size_of(const Cone& cone) {
  const double z = greatest(std::fabs(cone.z_min), std::fabs(cone.z_max));
  return z < infinity ? z : 1.0;
}

}  // namespace rayfarm
