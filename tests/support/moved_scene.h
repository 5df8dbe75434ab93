// The same scene elsewhere, or in another unit of length.
#pragma once
#include "common/scene/scene.h"

namespace rayfarm {

/// All lengths times 2^k, dimming with distance accordingly: the same picture, bit by bit.
Scene scaled(Scene scene, int k);

/// Everything moved: the same picture but for the rounding of coordinates.
Scene shifted(Scene scene, const glm::dvec3& by);

}  // namespace rayfarm
