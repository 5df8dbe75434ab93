// Every solid by its definition alone, for tests that ask whether a point is in it or on it.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "common/geometry/solid.h"
#include "common/math/overload.h"

namespace rayfarm {

/// Of each kind at least one; where a parameter changes what it looks like, one of each look.
inline std::vector<Solid> all_solids() {
  constexpr double endless = std::numeric_limits<double>::infinity();
  return {Sphere{},       Cube{},          Plane{},          Cylinder{-0.5, 0.75},
          Cylinder{},     Cone{-0.75, 1},  Cone{0.25, 1},    Cone{-1, endless},
          Torus{1, 0.25}, Torus{0.5, 0.8}, RoundedCube{0.2}, RoundedCube{0.5}};
}

/// Positive outside, negative inside, near the surface about the distance from it. Any vector type will do.
template <class Vec>
auto beyond(const Solid& solid, const Vec& p) {
  using Real = std::remove_cvref_t<decltype(p.x)>;
  const Real round = std::hypot(p.x, p.y);
  const auto limits = [](Real low, Real high, Real at) { return std::max(low - at, at - high); };
  return std::visit(
      Overload{[&](const Sphere&) -> Real { return std::hypot(round, p.z) - 1; },
               [&](const Cube&) -> Real {
                 return std::max({limits(0, 1, p.x), limits(0, 1, p.y), limits(0, 1, p.z)});
               },
               [&](const Plane&) -> Real { return p.z; },
               [&](const Cylinder& c) -> Real { return std::max(round - 1, limits(c.z_min, c.z_max, p.z)); },
               [&](const Cone& c) -> Real {
                 return std::max(round - std::fabs(p.z), limits(c.z_min, c.z_max, p.z));
               },
               // Of a spindle torus the lemon inside is left out.
               [&](const Torus& t) -> Real {
                 return std::max(std::hypot(round - t.R, p.z) - t.r, t.r - std::hypot(round + t.R, p.z));
               },
               [&](const RoundedCube& c) -> Real {
                 const auto out = [&](Real at) { return std::max(limits(c.r, 1 - Real(c.r), at), Real(0)); };
                 const Real x = out(p.x), y = out(p.y), z = out(p.z);
                 return std::sqrt(x * x + y * y + z * z) - c.r;
               },
               [](const auto& faceted) -> Real {
                 throw std::invalid_argument(std::string(faceted.name) + " has no definition in numbers");
               }},
      solid);
}

template <class Vec>
bool contains(const Solid& solid, const Vec& p) {
  return beyond(solid, p) < 0;
}

}  // namespace rayfarm
