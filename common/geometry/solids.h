// All solids, as rays meet them. Each has a header with these functions of it, in its local space:
//
//   interval_of(solid, ray)                     where the line is inside, of a convex solid; and
//   exit_from_surface(solid, ray)               where a ray leaves it that starts on it and goes inward; and, to be
//                                               fast,
//   glance_at(solid, ray)                       the first without bounds, where that can do (see Glance);
//   crossings_of(solid, ray)                    or, of any other solid, its crossings ahead of the ray; and
//   crossings_from_surface(solid, ray, inward)  the same but the one at the origin, for a ray that starts on it;
//   surface_of(solid, ray, t, entering)         the surface at a crossing: point and normal;
//   texture_of(solid, surface point)            texture coordinates;
//   extent_of(solid, row)                       the range of dot(row, p) over its points p;
//   size_of(solid)                              the largest |coordinate| of its points; of an endless solid that of
//                                               the parts that end.
#pragma once
#include "common/geometry/cone.h"
#include "common/geometry/cube.h"
#include "common/geometry/cylinder.h"
#include "common/geometry/faceted_solid.h"
#include "common/geometry/plane.h"
#include "common/geometry/rounded_cube.h"
#include "common/geometry/sphere.h"
#include "common/geometry/torus.h"

namespace rayfarm {

template <class S>
concept ConvexSolid = requires(const S& solid, const LocalRay<double>& ray) {
  interval_of(solid, ray);
};

inline bool is_convex(const Solid& solid) {
  return std::visit([]<class S>(const S&) { return ConvexSolid<S>; }, solid);
}

/// The solids that have a glance_at(). One after the other: most are the first, and each is compiled into the caller.
[[gnu::always_inline]] inline Glance glance_at(const Solid& solid, const LocalRay<double>& ray) {
  if (const auto* sphere = std::get_if<Sphere>(&solid)) return glance_at(*sphere, ray);
  if (const auto* plane = std::get_if<Plane>(&solid)) return glance_at(*plane, ray);
  if (const auto* cylinder = std::get_if<Cylinder>(&solid)) return glance_at(*cylinder, ray);
  if (const auto* cube = std::get_if<Cube>(&solid)) return glance_at(*cube, ray);
  return {};
}

}  // namespace rayfarm
