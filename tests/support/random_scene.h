// Random scenes for property tests: trees of all solids and all four operations, at most five levels deep,
// with materials, textures and lights of every kind. A seed always gives the same scene.
#pragma once
#include <cstdint>

#include "common/scene/scene.h"

namespace rayfarm {

/// Any affine transforms, mirroring and shear among them. No surface meets another one face to face.
Scene random_scene(std::uint64_t seed);

/// All coordinates and transforms on a grid of quarters and axis-parallel, so that faces coincide again and
/// again. The camera stands anywhere.
Scene random_snapped_scene(std::uint64_t seed);

/// random_scene(seed) seen by any camera, with what few scenes have: all solids, glow shells, stripes, parts without
/// a shadow.
Scene random_special_scene(std::uint64_t seed);

/// random_scene(seed) or random_snapped_scene(seed), in turn, where cubes and spheres may be closed meshes and Bezier
/// surfaces, with an open one beside it.
Scene random_faceted_scene(std::uint64_t seed);

}  // namespace rayfarm
