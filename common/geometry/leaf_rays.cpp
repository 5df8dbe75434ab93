// What a ray meets of a leaf.
#include "common/geometry/leaf.h"

namespace rayfarm {
namespace {

/// The errors of a ray in twice the digits, and nothing else of it.
LocalRay<DoubleDouble> precise_errors(const Leaf& leaf, const RayQuery& q) {
  const Leaf::Precise& of = leaf.precise;
  LocalRay<DoubleDouble> local;
  local.origin_error =
      DoubleDouble(of.error_per_size * q.origin_size + of.origin_error + leaf.stretch * q.ray.origin_error);
  local.direction_error = DoubleDouble(of.error_per_size * q.direction_size);
  local.spread =
      DoubleDouble((of.spread_per_size + 0x1p-1000) * q.direction_size);  // a quotient must not overflow
  local.aside = precise(leaf.aside), local.share = precise(leaf.share);
  return local;
}

void put_precise_axis(LocalRay<DoubleDouble>& local, int axis, const Leaf& leaf, const RayQuery& q) {
  const Vec3<DoubleDouble> row = precise(leaf.row[axis]);
  local.origin[axis] =
      dot(row, precise(q.ray.origin)) + DoubleDouble{leaf.offset[axis], leaf.precise.offset_rest[axis]};
  local.direction[axis] = dot(row, precise(q.ray.direction));
}

}  // namespace

LocalRay<DoubleDouble> to_local_precisely(const Leaf& leaf, const RayQuery& q) {
  LocalRay<DoubleDouble> local = precise_errors(leaf, q);
  for (int axis = 0; axis < 3; ++axis) put_precise_axis(local, axis, leaf, q);
  return local;
}

namespace {

template <ConvexSolid S>
Interval<double> settled_interval(const S& solid, const Leaf& leaf, const RayQuery& q) {
  return rounded(interval_of(solid, to_local_precisely(leaf, q)));
}

/// Between the cylinder's planes, for a ray that double precision does not hold to be parallel to them.
Interval<double> settled_slab(const Cylinder& c, const Leaf& leaf, const RayQuery& q) {
  LocalRay<DoubleDouble> ray = precise_errors(leaf, q);
  put_precise_axis(ray, 2, leaf, q);
  return rounded(slab_interval(ray, 2, DoubleDouble{c.z_min}, DoubleDouble{c.z_max}));
}

/// Mostly the ray starts in the plane of a cap: then the digits of one axis do, unless it passes the cap's rim.
Interval<double> settled_interval(const Cylinder& c, const Leaf& leaf, const RayQuery& q) {
  const LocalRay<double> ray = to_local(leaf, q);
  const Interval<double> tube = tube_interval(ray);
  if (!tube.is_in_doubt() && std::fabs(ray.direction.z) > ray.spread) {
    const Interval<double> inside = intersection(tube, settled_slab(c, leaf, q));
    if (inside.enter.lo > inside.leave.hi || inside.enter.hi < inside.leave.lo) return inside;
  }
  return rounded(interval_of(c, to_local_precisely(leaf, q)));
}

}  // namespace

Interval<double> settled_interval(const Leaf& leaf, const RayQuery& q) {
  return std::visit(
      [&]<class S>(const S& solid) {
        if constexpr (ConvexSolid<S>)
          return settled_interval(solid, leaf, q);
        else
          return Interval<double>{};
      },
      leaf.solid);
}

Crossings crossings(const Leaf& leaf, const RayQuery& q) {
  const LocalRay<double> ray = to_local(leaf, q);
  return std::visit(
      [&]<class S>(const S& solid) {
        if constexpr (ConvexSolid<S>) {
          const Interval<double> interval = interval_of(solid, ray);
          return ahead(interval.is_in_doubt() ? settled_interval(leaf, q) : interval);
        } else {
          Crossings found = crossings_of(solid, ray);
          if (found.wants_digits) found = crossings_of(solid, to_local_precisely(leaf, q));
          return found;
        }
      },
      leaf.solid);
}

namespace {

/// A convex solid is left for good outward; inward there is one crossing, on the far side.
template <ConvexSolid S>
Crossings crossings_from_surface(const S& solid, const LocalRay<double>& ray, bool inward) {
  Crossings found;
  if (!inward) return found;
  found.starts_inside = true;
  const Bounded<double> exit = exit_from_surface(solid, ray);
  // Grazing inward, the exit can round to the origin or behind it.
  if (exit.t < infinity) found.add(crossing_at(exit.t > 0 ? exit : bounded(0.0, 0.0)));
  return found;
}

}  // namespace

Crossings crossings_from_surface(const Leaf& leaf, const LocalRay<double>& ray, bool inward) {
  return std::visit([&](const auto& solid) { return crossings_from_surface(solid, ray, inward); },
                    leaf.solid);
}

SurfacePoint surface_at(const Leaf& leaf, const LocalRay<double>& ray, double t, bool entering) {
  return std::visit([&](const auto& solid) { return surface_of(solid, ray, t, entering); }, leaf.solid);
}

TextureCoordinates texture_at(const Leaf& leaf, const SurfacePoint& s) {
  return std::visit([&](const auto& solid) { return texture_of(solid, s); }, leaf.solid);
}

FacetPoint facet_at(const Leaf& leaf, const LocalRay<double>& ray, const FacetCrossing& crossing) {
  const Mesh* mesh = std::get_if<Mesh>(&leaf.solid);
  return point_at(*leaf.facets, ray, crossing, mesh && mesh->smooth);
}

Vec3d normal_to_world(const Leaf& leaf, const Vec3d& n) {
  return normalized(leaf.row[0] * n.x + leaf.row[1] * n.y + leaf.row[2] * n.z);
}

}  // namespace rayfarm
