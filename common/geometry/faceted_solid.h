// Meshes and Bezier surfaces among the solids. Rays meet their facets (facets.h), which a leaf has beside them; what all
// solids are asked for is empty here.
#pragma once
#include <concepts>

#include "common/geometry/crossing.h"
#include "common/geometry/ray.h"
#include "common/geometry/solid.h"
#include "common/geometry/surface_point.h"

namespace rayfarm {

template <class S>
concept FacetedSolid = std::same_as<S, Mesh> || std::same_as<S, Bezier>;

template <FacetedSolid S, class T>
Crossings crossings_of(const S&, const LocalRay<T>&) {
  return {};
}
template <FacetedSolid S>
Crossings crossings_from_surface(const S&, const LocalRay<double>&, bool /*inward*/) {
  return {};
}
template <FacetedSolid S>
SurfacePoint surface_of(const S&, const LocalRay<double>&, double /*t*/, bool /*entering*/) {
  return {};
}
template <FacetedSolid S>
TextureCoordinates texture_of(const S&, const SurfacePoint&) {
  return {};
}
template <FacetedSolid S>
Extent extent_of(const S&, const Vec3d& /*row*/) {
  return {-infinity, infinity};
}
template <FacetedSolid S>
double size_of(const S&) {
  return 1;
}

}  // namespace rayfarm
