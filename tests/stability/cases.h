// The cases of the suite, by their numbers in the list S1 to S30 of the README's section on stability.
#pragma once
#include "tests/stability/suite.h"

namespace rayfarm::stability {

std::vector<Case> sphere_cases();             // S1 to S3
std::vector<Case> quadric_cases();            // S5 to S7
std::vector<Case> torus_cases();              // S8, S9
std::vector<Case> transform_cases();          // S4, S15
std::vector<Case> bezier_cases();             // S10
std::vector<Case> triangle_cases();           // S11
std::vector<Case> shared_face_cases();        // S12
std::vector<Case> twin_cases();               // S13
std::vector<Case> stacked_slab_cases();       // S14
std::vector<Case> menger_cases();             // S16
std::vector<Case> random_tree_cases();        // S17
std::vector<Case> logic_cases();              // S18, S21
std::vector<Case> self_intersection_cases();  // S19
std::vector<Case> refraction_cases();         // S20
std::vector<Case> sampler_cases();            // S22
std::vector<Case> same_bits_cases();          // S26; between programs: same_bytes_test, builds.sh
std::vector<Case> whole_scene_cases();        // S30

/// All of them, in the order of their numbers.
std::vector<Case> all_cases();

}  // namespace rayfarm::stability
