#include "tests/stability/cases.h"

namespace rayfarm::stability {

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (const auto& group : {
           sphere_cases(),
           quadric_cases(),
           torus_cases(),
           transform_cases(),
           bezier_cases(),
           triangle_cases(),
           shared_face_cases(),
           twin_cases(),
           stacked_slab_cases(),
           menger_cases(),
           random_tree_cases(),
           logic_cases(),
           self_intersection_cases(),
           refraction_cases(),
           sampler_cases(),
           same_bits_cases(),
           whole_scene_cases(),
       })
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace rayfarm::stability
