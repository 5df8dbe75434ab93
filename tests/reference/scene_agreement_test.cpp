// The bundled scenes, pixel centre by pixel centre.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "master/script/script.h"
#include "tests/reference/comparison.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t width = 320, height = 240;

void expect_agreement(const std::string& scene, const std::map<std::string, std::string>& params = {},
                      std::uint32_t y0 = 0, std::uint32_t y1 = height) {
  const std::string file = std::string(RAYFARM_SOURCE_DIR) + "/scenes/" + scene + ".lua";
  RenderSettings settings;
  settings.width = width, settings.height = height;
  Comparison comparison(scene, evaluate_file(file, params, 0).scene, settings);
  comparison.compare_rows(y0, y1);
  comparison.expect_few_at_edges();
}

TEST(Agreement, SpherePlane) { expect_agreement("sphere_plane"); }
TEST(Agreement, HedgehogInTheCage) { expect_agreement("hedgehog_in_the_cage"); }
TEST(Agreement, Circus) { expect_agreement("circus"); }
TEST(Agreement, TestSceneWithAPointLight) { expect_agreement("test_scene", {{"light", "point"}}); }
TEST(Agreement, TestSceneWithARectangleLight) { expect_agreement("test_scene", {{"light", "rectangle"}}); }
TEST(Agreement, SphereFlakeOfMirrors) {
  expect_agreement("sphere_flake", {{"depth", "3"}, {"mat", "mirror"}});
}
TEST(Agreement, SphereFlakeOfGlass) { expect_agreement("sphere_flake", {{"depth", "3"}, {"mat", "glass"}}); }

// The reference tries all 2801 spheres for each ray: bands, so that several cores share the work.
constexpr std::uint32_t bands = 8;
class BandAgreement : public testing::TestWithParam<std::uint32_t> {};

TEST_P(BandAgreement, SphereFlakeOfDepthFive) {
  expect_agreement("sphere_flake", {{"depth", "5"}}, GetParam() * height / bands,
                   (GetParam() + 1) * height / bands);
}
INSTANTIATE_TEST_SUITE_P(OfEight, BandAgreement, testing::Range(0u, bands));

}  // namespace
}  // namespace rayfarm
