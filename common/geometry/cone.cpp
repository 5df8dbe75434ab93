#include "common/geometry/cone.h"

#include <cmath>

namespace rayfarm {
namespace {

/// Nearer to a cap's plane than to the side.
bool is_on_cap(const Cone& cone, const Vec3d& p) {
  const double side = std::fabs(std::sqrt(p.x * p.x + p.y * p.y) - std::fabs(p.z)) * 0.7;
  return least(std::fabs(p.z - cone.z_min), std::fabs(p.z - cone.z_max)) < side;
}

/// The origin is in one of the nappes, which is left first.
Crossings inward_from_cap(const Interval<double>& slab, const NappeIntervals<double>& nappes) {
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
  const double A = cone_metric(ray.direction, ray.direction), B = cone_metric(ray.origin, ray.direction);
  const double size = sum_abs(ray.direction), relative = ray.spread / size + 4 * unit_roundoff;
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
