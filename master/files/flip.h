// LDR-FLIP: how different two pictures look when one flips between them.
// Source: P. Andersson et al., FLIP: A Difference Evaluator for Alternating Images, PACMCGIT 3(2), 2020.
#pragma once
#include <vector>

#include "master/files/image_file.h"

namespace rayfarm {

/// The error map, 0..1, the same in all three channels, for linear pictures of the same size shown clamped to
/// 0..1 at 67 pixels per degree (a 0.7 m wide 4K screen at 0.7 m).
std::vector<float> flip_error(const Picture& reference, const Picture& test);

}  // namespace rayfarm
