// Where a line is inside a solid, in 113 bits: the ground truth that solvers are held against.
#pragma once
#include <vector>

#include "common/geometry/solid.h"
#include "tests/stability/quad.h"

namespace rayfarm::stability {

/// The whole line counts: it is inside at t = -infinity or not, and changes sides at each crossing.
struct QuadSpans {
  bool starts_inside = false;
  std::vector<Quad> at;  // ascending
};

QuadSpans quad_spans(const Solid& solid, const QuadRay& local);

}  // namespace rayfarm::stability
