#include "common/render/glow.h"

namespace rayfarm {
namespace {

/// The sine of the angle between ray and normal where the ray passes a unit sphere: how far from its centre it goes.
double distance_from_centre(const LocalRay<double>& ray) { return length(closest_approach(ray).p); }

}  // namespace

GlowShell make_glow_shell(const Glow& glow, const BoundedAffine& world_from_local) {
  const auto* tube = std::get_if<Cylinder>(&glow.shape);
  return {make_leaf(tube ? Solid(Cylinder{}) : Solid(Sphere{}), world_from_local),
          tube ? tube->z_min : -infinity, tube ? tube->z_max : infinity, vec(glow.color), glow.exponent};
}

std::optional<Vec3d> glow_along(const GlowShell& shell, const RayQuery& query,
                                const std::optional<Hit>& hit) {
  const LocalRay<double> ray = to_local(shell.leaf, query);
  const std::optional<Interval<double>> inside = convex_interval(shell.leaf, query);
  if (!inside || inside->enter.lo > inside->leave.hi || inside->enter.lo <= 0) return std::nullopt;
  if (hit && inside->enter.lo > hit->t + hit->t_error) return std::nullopt;
  const double z = ray.origin.z + inside->enter.t * ray.direction.z;
  if (!(shell.z_min < z && z < shell.z_max)) return std::nullopt;
  const bool is_tube = std::holds_alternative<Cylinder>(shell.leaf.solid);
  const double sine = distance_from_centre(is_tube ? across_axis(ray) : ray);
  return shell.color * deterministic::integer_power(1 - least(sine, 1), shell.exponent);
}

}  // namespace rayfarm
