// Random scenes, sampled on a grid that no symmetry of the scene shares.
#include <gtest/gtest.h>

#include <string>

#include "tests/reference/comparison.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

void expect_agreement_on_random_scenes(const std::string& family, Scene (*make)(std::uint64_t),
                                       std::uint64_t first, std::uint64_t last) {
  RenderSettings settings;
  settings.width = 320, settings.height = 240;
  settings.max_depth = 4;
  for (std::uint64_t seed = first; seed < last && !testing::Test::HasFailure(); ++seed) {
    Comparison comparison(family + " " + std::to_string(seed), make(seed), settings);
    for (double y = 3.137; y < settings.height; y += 17.31)
      for (double x = 5.713; x < settings.width; x += 15.77) comparison.compare_at(x, y);
    comparison.expect_few_at_edges();
  }
}

TEST(Agreement, RandomScenesOfAnyTransforms) {
  expect_agreement_on_random_scenes("random", random_scene, 0, 150);
}
TEST(Agreement, RandomScenesOfCoincidentFaces) {
  expect_agreement_on_random_scenes("snapped", random_snapped_scene, 0, 150);
}

TEST(Agreement, RandomScenesWithAllThatFewScenesHave) {
  expect_agreement_on_random_scenes("special", random_special_scene, 0, 150);
}

TEST(Agreement, RandomScenesOfMeshesAndPatches) {
  expect_agreement_on_random_scenes("faceted", random_faceted_scene, 0, 60);
}

}  // namespace
}  // namespace rayfarm
