// The torus of the reference tracer, in 113-bit precision.
#pragma once
#include "tests/reference/reference_solids.h"

namespace rayfarm::reference {

/// The spans of a torus: the points with (|p|^2 + R^2 - r^2)^2 < 4 R^2 (x^2 + y^2). A line that only touches
/// the surface does not cross it.
Spans spans_of_torus(const Torus& torus, const Ray& local);

}  // namespace rayfarm::reference
