// The bundled scenes, pixel centre by pixel centre.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "master/script/script.h"
#include "tests/reference/comparison.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t width = 320, height = 240;

Comparison comparison_of(const std::string& name, const Scene& scene) {
  RenderSettings settings;
  settings.width = width, settings.height = height;
  leave_out(settings, scene.image);
  return {name, scene, settings};
}

Scene scene_of(const std::string& name, const std::map<std::string, std::string>& params,
               std::uint32_t frame) {
  return evaluate_file(std::string(RAYFARM_SOURCE_DIR) + "/scenes/" + name + ".lua", params, frame).scene;
}

void expect_agreement(const std::string& name, const std::map<std::string, std::string>& params = {},
                      std::uint32_t frame = 0) {
  Comparison comparison = comparison_of(name, scene_of(name, params, frame));
  comparison.compare_rows(0, height);
  comparison.expect_few_at_edges();
}

TEST(Agreement, SpherePlane) { expect_agreement("sphere_plane"); }
TEST(Agreement, HedgehogInTheCage) { expect_agreement("hedgehog_in_the_cage"); }
TEST(Agreement, Circus) { expect_agreement("circus"); }
TEST(Agreement, TestSceneWithAPointLight) { expect_agreement("test_scene", {{"light", "point"}}); }
TEST(Agreement, TestSceneWithARectangleLight) { expect_agreement("test_scene", {{"light", "rectangle"}}); }
TEST(Agreement, TwoSpheresOfGlass) { expect_agreement("two_spheres"); }
TEST(Agreement, TwoSpheresOfMirrors) {
  expect_agreement("two_spheres", {{"mat", "mirror"}, {"schlick", "0"}});
}
TEST(Agreement, FiveBalls) { expect_agreement("five_balls"); }
TEST(Agreement, Cubes) { expect_agreement("cubes"); }
TEST(Agreement, CubesOfGlass) { expect_agreement("cubes", {{"mat", "glass"}}); }
TEST(Agreement, Cylinders) { expect_agreement("cylinders"); }
TEST(Agreement, CylindersGlow) { expect_agreement("cylinders_glow"); }
TEST(Agreement, Toroids) { expect_agreement("toroids"); }
TEST(Agreement, ToroidsOrienteering) { expect_agreement("toroids_orienteering"); }
TEST(Agreement, Optics) { expect_agreement("optics"); }
TEST(Agreement, OpticsByRayCasting) { expect_agreement("optics", {{"rc", "true"}}); }
TEST(Agreement, Bezier) { expect_agreement("bezier"); }
TEST(Agreement, Glasshenge) {
  // Not in the centres: the symmetric camera sees exact edges of the floor's squares through very many of them.
  Comparison comparison = comparison_of("glasshenge", scene_of("glasshenge", {}, 0));
  comparison.compare_rows(0, height, 0.4321);
  comparison.expect_few_at_edges();
}
TEST(Agreement, Flags) { expect_agreement("flags"); }
TEST(Agreement, AnimatedScene) { expect_agreement("animated_scene", {}, 77); }
TEST(Agreement, SphereFlakeOfMirrors) {
  expect_agreement("sphere_flake", {{"depth", "3"}, {"mat", "mirror"}});
}
TEST(Agreement, SphereFlakeOfGlass) { expect_agreement("sphere_flake", {{"depth", "3"}, {"mat", "glass"}}); }

// The reference tries all 2801 spheres for each ray: bands, so that several cores share the work.
constexpr std::uint32_t bands = 8;
class BandAgreement : public testing::TestWithParam<std::uint32_t> {};

TEST_P(BandAgreement, SphereFlakeOfDepthFive) {
  Comparison comparison = comparison_of("sphere_flake", scene_of("sphere_flake", {{"depth", "5"}}, 0));
  comparison.compare_rows(GetParam() * height / bands, (GetParam() + 1) * height / bands);
  comparison.expect_few_at_edges();
}
INSTANTIATE_TEST_SUITE_P(OfEight, BandAgreement, testing::Range(0u, bands));

}  // namespace
}  // namespace rayfarm
