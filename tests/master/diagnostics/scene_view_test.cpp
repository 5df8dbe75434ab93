#include "master/diagnostics/scene_view.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/render/world_parts.h"
#include "master/diagnostics/leaf_names.h"
#include "tests/support/random_scene.h"
#include "tests/support/simple_job.h"

namespace rayfarm {
namespace {

using nlohmann::json;

json view_of(const Scene& scene) { return scene_view(ReadyScene(scene)); }

TEST(SceneView, ShowsCameraLightsAndSolids) {
  Scene scene = simple_scene();
  scene.lights.push_back(PointLight{{1, 2, 3}, {4, 5, 6}});
  const json view = view_of(scene);
  EXPECT_EQ(view["background"], json({0.0, 0.02, 0.03}));
  EXPECT_EQ(view["camera"]["from"], json({0.0, 0.0, -5.0}));
  EXPECT_EQ(view["lights"][0]["kind"], "ambient");
  EXPECT_EQ(view["lights"][1],
            json({{"kind", "point"}, {"at", {1.0, 2.0, 3.0}}, {"intensity", {4.0, 5.0, 6.0}}}));
  const json ball = view["solids"][0];
  EXPECT_EQ(ball["name"], "ball #0");
  EXPECT_EQ(ball["kind"], "sphere");
  EXPECT_EQ(ball["matrix"], json({1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0.}));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(ball["box"]["min"][axis], -1, 1e-9);
    EXPECT_NEAR(ball["box"]["max"][axis], 1, 1e-9);
  }
  EXPECT_EQ(view["truncated"], false);
}

TEST(SceneView, ShowsEveryLeafInTheOrderOfItsNumber) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = random_scene(seed);
    const World world(scene);
    const json solids = view_of(scene)["solids"];
    const std::vector<std::string> names = leaf_names(scene);
    ASSERT_EQ(solids.size(), names.size());
    for (std::size_t leaf = 0; leaf < names.size(); ++leaf) {
      EXPECT_EQ(solids[leaf]["leaf"], leaf);
      EXPECT_EQ(solids[leaf]["name"], names[leaf]);
      const Affine& placement = world.parts().placements[leaf].map;
      const glm::dvec3 moved = point(placement, {1, 2, 3});
      for (int row = 0; row < 3; ++row) {
        const json& m = solids[leaf]["matrix"];
        const auto at = [&](int column) {
          return m[static_cast<std::size_t>(4 * row + column)].get<double>();
        };
        EXPECT_NEAR(at(0) + 2 * at(1) + 3 * at(2) + at(3), moved[row], 1e-9 * (1 + std::fabs(moved[row])));
      }
    }
  }
}

TEST(SceneView, WhatIsEndlessHasNoBoxUnlessItIsCut) {
  Scene scene = simple_scene();
  scene.nodes[0].content = Solid{Plane{}};
  EXPECT_EQ(view_of(scene)["solids"][0]["box"], nullptr);
  scene.nodes.insert(scene.nodes.begin(), Node{Operation{CsgOp::intersect, 2}, {}, {}, {}, {}, ""});
  scene.nodes.push_back({Solid{Sphere{}}, {}, {}, {}, {}, ""});
  EXPECT_NEAR(view_of(scene)["solids"][0]["box"]["min"][0], -1, 1e-9);
  scene.nodes[1].content = Solid{Cylinder{-1, infinity}};
  EXPECT_EQ(view_of(scene)["solids"][0]["parameters"], json({{"z_min", -1.0}, {"z_max", nullptr}}));
}

TEST(SceneView, ShowsTheFirstOfVeryMany) {
  Scene scene = simple_scene();
  const auto many = static_cast<std::uint32_t>(most_solids_shown + 1);
  scene.nodes.insert(scene.nodes.begin(), Node{Operation{CsgOp::unite, many}, {}, {}, {}, {}, ""});
  scene.nodes.resize(many + 1, Node{scene.nodes[1]});
  const json view = view_of(scene);
  EXPECT_EQ(view["solids"].size(), most_solids_shown);
  EXPECT_EQ(view["truncated"], true);
}

}  // namespace
}  // namespace rayfarm
