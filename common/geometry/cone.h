// The cone x^2 + y^2 < z^2 between z_min and z_max, its apex at the origin: two nappes, each convex.
//
// With p the line's closest approach to the apex, n its unit direction and g(s) = (x^2 + y^2 - z^2) / 2 at p + s n, a
// quarter of the discriminant of g is mx^2 + my^2 - mz^2, m = p x n: nothing cancels but at a tangent line. Sources:
// D. Eberly, Intersection of a Line and a Cone, Geometric Tools, 2000 (the nappes); the discriminant is Lagrange's
// identity in the metric (+, +, -).
#pragma once
#include "common/geometry/crossing.h"
#include "common/geometry/cube.h"
#include "common/geometry/ray.h"
#include "common/geometry/solid.h"
#include "common/geometry/sphere.h"
#include "common/geometry/surface_point.h"

namespace rayfarm {

/// Where a line is inside the two nappes, in the line's order.
struct NappeIntervals {
  Interval<double> first, second;
};

NappeIntervals nappe_intervals(const LocalRay<double>& ray);

/// The crossings ahead of the ray's origin.
Crossings crossings_of(const Cone& cone, const LocalRay<double>& ray);
/// For a ray that starts on the cone: the crossing at the origin is known and left out.
Crossings crossings_from_surface(const Cone& cone, const LocalRay<double>& ray, bool inward);

SurfacePoint surface_of(const Cone& cone, const LocalRay<double>& ray, double t, bool entering);

/// u runs around the axis on the side and is 0 on the caps; v = z.
TextureCoordinates texture_of(const Cone& cone, const SurfacePoint& s);

Extent extent_of(const Cone& cone, const Vec3d& row);
double size_of(const Cone& cone);

}  // namespace rayfarm
