// How the original renderer finds crossings, its numerical faults included: in place of the reference's own rules they
// give the original's picture, to be held beside ours (DIFFERENCES.md).
#pragma once
#include "tests/reference/reference_spans.h"

namespace rayfarm::reference {

/// A torus by the closed formulas for a quartic, in double precision, all t 0.001 before their points; cylinders and
/// half-spaces missed by parallel rays; faces that are one only if their t are equal; whatever is nearer than 1e-4 to
/// a secondary ray's start left behind; behind a sheet's front an inside without an end; in shadows of parts only what is
/// on the surface of the whole.
Rules original_rules();

}  // namespace rayfarm::reference
