// The solids of the reference tracer, each by its formula, over the whole line and in extended precision.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "common/geometry/solid.h"

namespace rayfarm::reference {

using Real = long double;
using Vec = glm::vec<3, Real, glm::defaultp>;
using Mat = glm::mat<3, 3, Real, glm::defaultp>;
using Uv = glm::vec<2, Real, glm::defaultp>;

struct Ray {
  Vec origin{0}, direction{0};
};

struct Crossing {
  Real t = 0;
  Real to_point = 0;      // its point is at t + to_point: 0 but by the original's rules
  int leaf = 0;           // preorder number among the leaves
  bool entering = false;  // the state behind it: inside the result of the operators so far
  Vec gradient{0};        // local, points out of the solid
  Vec normal{0};          // world, unit, points out of the solid
  Real size = 0;          // of the coordinates it was made from
  Uv uv{0};               // of meshes and Bezier surfaces
  bool of_sheet = false;  // the gradient points to the front, whichever way it is passed
};

/// The line is inside from t = -infinity (or not), and changes sides at each crossing.
struct Spans {
  bool starts_inside = false;
  std::vector<Crossing> crossings;  // ascending t
};

/// The spans of one solid in its local space; t is that of the ray given. Only t and gradient are set. Meshes and Bezier
/// surfaces have theirs in reference_surfaces.h.
Spans spans_of(const Solid& solid, const Ray& local);

/// Texture coordinates at a point of the surface, whose gradient tells the faces apart.
Uv uv_of(const Solid& solid, const Vec& local, const Vec& gradient);

}  // namespace rayfarm::reference
