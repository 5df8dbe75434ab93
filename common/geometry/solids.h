// All solids, as rays meet them. Each has a header with these functions of it, in its local space:
//
//   interval_of(solid, ray)                     where the line is inside, of a convex solid; and
//   exit_from_surface(solid, ray)               where a ray leaves it that starts on it and goes inward;
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

}  // namespace rayfarm
