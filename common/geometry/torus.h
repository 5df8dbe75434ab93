// The torus about the z axis; a spindle torus (R < r) is the apple without the lemon.
//
// The ray's origin is moved to its closest approach to the centre before anything is squared; the quartic's
// critical points (roots of a depressed cubic) cut the line into monotone pieces; a piece whose ends differ
// in sign holds one root, found on the geometric form, not on the expanded quartic. Both ends of the line are
// outside, so the number of crossings is even by construction. Sources: C. Yuksel, High-Performance
// Polynomial Root Finding for Graphics, HPG 2022 (bracketing between critical points); POV-Ray's "closer"
// origin for quartics; R. P. Brent, Algorithms for Minimization without Derivatives.
#pragma once
#include "common/geometry/crossing.h"
#include "common/geometry/ray.h"
#include "common/geometry/solid.h"
#include "common/geometry/surface_point.h"

namespace rayfarm {

/// The crossings ahead of the ray's origin.
template <class T>  // double or DoubleDouble
Crossings crossings_of(const Torus& torus, const LocalRay<T>& ray);

/// For a ray that starts on the torus: the crossing at the origin is known and left out.
Crossings crossings_from_surface(const Torus& torus, const LocalRay<double>& ray, bool inward);

SurfacePoint surface_of(const Torus& torus, const LocalRay<double>& ray, double t, bool entering);

/// u runs around the axis, v around the tube.
TextureCoordinates texture_of(const Torus& torus, const SurfacePoint& s);

inline Extent extent_of(const Torus& torus, const Vec3d& row) {
  return about_zero(torus.R * std::sqrt(row.x * row.x + row.y * row.y) + torus.r * length(row));
}
inline double size_of(const Torus& torus) { return torus.R + torus.r; }

}  // namespace rayfarm
