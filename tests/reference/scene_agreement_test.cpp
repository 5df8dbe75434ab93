// The bundled scenes, pixel centre by pixel centre.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "master/script/script.h"
#include "tests/reference/comparison.h"

namespace rayfarm {
namespace {

void expect_agreement(const std::string& scene, const std::map<std::string, std::string>& params = {},
                      std::uint32_t stride = 1) {
  const std::string file = std::string(RAYFARM_SOURCE_DIR) + "/scenes/" + scene + ".lua";
  RenderSettings settings;
  settings.width = 320, settings.height = 240;
  Comparison comparison(scene, evaluate_file(file, params, 0).scene, settings);
  comparison.compare_pixel_centres(stride);
  comparison.expect_few_at_edges();
}

TEST(Agreement, SpherePlane) { expect_agreement("sphere_plane"); }
TEST(Agreement, HedgehogInTheCage) { expect_agreement("hedgehog_in_the_cage"); }
TEST(Agreement, Circus) { expect_agreement("circus"); }
TEST(Agreement, TestSceneWithAPointLight) { expect_agreement("test_scene", {{"light", "point"}}); }
TEST(Agreement, TestSceneWithARectangleLight) { expect_agreement("test_scene", {{"light", "rectangle"}}); }
TEST(Agreement, SphereFlakeOfDepthThree) { expect_agreement("sphere_flake", {{"depth", "3"}}); }
TEST(Agreement, SphereFlakeOfDepthFive) { expect_agreement("sphere_flake", {}, 8); }
TEST(Agreement, SphereFlakeOfMirrors) {
  expect_agreement("sphere_flake", {{"depth", "3"}, {"mat", "mirror"}});
}
TEST(Agreement, SphereFlakeOfGlass) { expect_agreement("sphere_flake", {{"depth", "3"}, {"mat", "glass"}}); }

}  // namespace
}  // namespace rayfarm
