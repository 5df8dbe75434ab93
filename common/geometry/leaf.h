// A leaf of the CSG tree made ready for rays: its solid, its transforms and how far off they may be.
#pragma once
#include <optional>

#include "common/geometry/bounds.h"
#include "common/geometry/crossing.h"
#include "common/geometry/facets.h"
#include "common/geometry/ray.h"
#include "common/geometry/solids.h"
#include "common/geometry/surface_point.h"
#include "common/math/affine.h"
#include "common/math/double_double.h"

namespace rayfarm {

/// A transform with a bound on each of its numbers' distance from the exact chain of products.
struct BoundedAffine {
  Affine map;
  glm::dmat3 linear_error{0.0};
  glm::dvec3 offset_error{0.0};
};

/// A node's own transform: as written in a script it is a product of a few rotations and scales already.
BoundedAffine bounded(const Affine& map);
BoundedAffine operator*(const BoundedAffine& a, const BoundedAffine& b);

/// What every ray test reads.
///
/// What is uncertain about the transform moves the solid as a whole: that is a constant of the leaf. Only rounding
/// grows with the ray's own size; of an endless solid the transform's uncertainty does too. All bounds are on the
/// largest component of a local vector, per largest component of the world's.
struct alignas(64) Leaf {
  Vec3d row[3];  // local = row * world + offset
  Vec3d offset;
  float sure_size;  // up to this RayQuery::size, glance_at() may be asked
  // Number of the first of the world's leaves that are the same solid in the same place: a ray that leaves one leaves
  // all of them.
  std::uint32_t surface = no_leaf - 1;  // of a leaf that is in no world
  Solid solid;
  double origin_error;     // wherever the line is at the solid
  double error_per_size;   // of a local vector, from rounding; what adds up along a ray
  double spread_per_size;  // of a direction in all
  double stretch;          // largest |local| for a world vector with components up to 1
  Vec3d share;             // of each axis in these four, at most 1
  Vec3d aside;  // where a point goes that is moved a little in world space, the same way for all leaves
  const Facets* facets = nullptr;  // of a mesh or Bezier surface; kept alive by the scene's assets

  bool is_sheet() const { return facets && !is_closed(*facets); }

  /// The same with nothing rounded, for rays that double precision cannot tell from others.
  struct Precise {
    Vec3d offset_rest;  // the exact offset less `offset`
    double origin_error, error_per_size, spread_per_size;
  } precise;
};

/// A mesh or Bezier surface comes with its facets.
Leaf make_leaf(const Solid& solid, const BoundedAffine& world_from_local, const Facets* facets = nullptr);

/// Whether they are the same solid in the same place, to the bit; what twins have in common.
bool are_twins(const Leaf& a, const Leaf& b);
std::uint64_t twin_hash(const Leaf& leaf);

/// Never too small; the error of the transform is included.
Box bounds_of(const Solid& solid, const BoundedAffine& world_from_local, const Facets* facets = nullptr);

/// The box around the transformed box; its error is included.
Box moved(const Box& box, const BoundedAffine& by);

[[gnu::always_inline]] inline LocalRay<double> to_local(const Leaf& leaf, const RayQuery& q) {
  const Vec3d &o = q.ray.origin, &d = q.ray.direction;
  return {{dot(leaf.row[0], o) + leaf.offset.x, dot(leaf.row[1], o) + leaf.offset.y,
           dot(leaf.row[2], o) + leaf.offset.z},
          {dot(leaf.row[0], d), dot(leaf.row[1], d), dot(leaf.row[2], d)},
          leaf.error_per_size * q.origin_size + leaf.origin_error + leaf.stretch * q.ray.origin_error,
          leaf.error_per_size * q.direction_size,
          leaf.spread_per_size * q.direction_size,
          leaf.aside,
          leaf.share};
}

/// What a convex solid does to the line, at a glance and ahead of the ray's origin. Unsure is any other solid.
[[gnu::always_inline]] inline Glance glance(const Leaf& leaf, const RayQuery& q) {
  if (!(q.size <= leaf.sure_size)) return {};
  return ahead(glance_at(leaf.solid, to_local(leaf, q)));
}

/// The same of a leaf that the ray starts on, going inward.
[[gnu::always_inline]] inline Glance exit_at_a_glance(const Leaf& leaf, const RayQuery& q) {
  const auto* sphere = std::get_if<Sphere>(&leaf.solid);
  if (!sphere || !(q.size <= leaf.sure_size)) return {};
  const Glance g = exit_at_a_glance(*sphere, to_local(leaf, q));
  return g.leave > g.blur ? g : Glance{};
}

inline Vec3<DoubleDouble> precise(const Vec3d& v) {
  return {DoubleDouble(v.x), DoubleDouble(v.y), DoubleDouble(v.z)};
}

/// In twice the digits: what is left of the error is that of the transform and of the ray's own origin.
LocalRay<DoubleDouble> to_local_precisely(const Leaf& leaf, const RayQuery& q);

/// Where the line is inside a convex leaf that double precision leaves in doubt: asked again with twice the digits.
/// What then is in doubt is so for the transform's sake, and goes by the nominal one.
Interval<double> settled_interval(const Leaf& leaf, const RayQuery& q);

/// Where the line is inside the leaf; none for a solid that is not convex: it has only a list of crossings.
inline std::optional<Interval<double>> convex_interval(const Leaf& leaf, const RayQuery& q) {
  const LocalRay<double> ray = to_local(leaf, q);
  return std::visit(
      [&]<class S>(const S& solid) -> std::optional<Interval<double>> {
        if constexpr (ConvexSolid<S>) {
          const Interval<double> interval = interval_of(solid, ray);
          return interval.is_in_doubt() ? settled_interval(leaf, q) : interval;
        } else {
          return std::nullopt;
        }
      },
      leaf.solid);
}

/// The leaf's crossings ahead of the ray. None of a leaf with facets: it can have any number of them (facets.h).
Crossings crossings(const Leaf& leaf, const RayQuery& q);
/// The same for a ray that starts on this leaf's surface: the crossing there is known and left out.
Crossings crossings_from_surface(const Leaf& leaf, const LocalRay<double>& ray, bool inward);

/// The surface at a crossing that crossings() found.
SurfacePoint surface_at(const Leaf& leaf, const LocalRay<double>& ray, double t, bool entering);
TextureCoordinates texture_at(const Leaf& leaf, const SurfacePoint& local);
/// The same for a leaf with facets: its crossing in this part.
FacetPoint facet_at(const Leaf& leaf, const LocalRay<double>& ray, const FacetCrossing& crossing);

/// Where a leaf stands: world_from_local, and what a point of the surface is off by behind it, each coordinate by at
/// most error_per_size * |local point| + error.
struct Placement {
  Affine map;
  glm::dmat3 error_per_size;
  glm::dvec3 error;
};
Placement make_placement(const BoundedAffine& world_from_local);

/// A local surface point in world space, with the bound on each coordinate's error.
struct WorldPoint {
  Vec3d point;
  double error;
};
WorldPoint to_world(const Placement& placement, const Vec3d& local);
/// The same for a point that is off by some more in local space.
WorldPoint to_world(const Placement& placement, const FacetPoint& local);
/// The outward unit normal in world space (inverse transpose, so mirroring and shear are right).
Vec3d normal_to_world(const Leaf& leaf, const Vec3d& local_normal);

}  // namespace rayfarm
