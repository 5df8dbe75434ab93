// Meshes and Bezier surfaces in scenes: a mesh of a solid is that solid, and no ray is lost.
#include <gtest/gtest.h>

#include "common/net/codec.h"
#include "common/render/render.h"
#include "tests/support/surfaces.h"

namespace rayfarm {
namespace {

Asset asset_with(AssetContent content) { return decode_asset(asset_data(content)); }

Node node_with(std::variant<Operation, Solid> content, const Affine& map = {}) {
  Node node;
  if (const auto* solid = std::get_if<Solid>(&content)) node.content = *solid;
  if (const auto* operation = std::get_if<Operation>(&content)) node.content = *operation;
  node.parent_from_node = map;
  return node;
}

/// A box with a ball taken out of it, and one of glass before it.
Scene scene_with(const Solid& box, std::vector<Asset> assets, bool of_glass) {
  Scene scene;
  scene.assets = std::move(assets);
  scene.materials.push_back({{0.2, 0.5, 0.9}, 0.1, 0.3, 0.4, 16, of_glass ? 0.8 : 0.0, 1.5, 1});
  const Affine turned = rotation_deg({1, 2, 3}, 40) * translation({-0.5, -0.5, -0.5});
  scene.nodes = {node_with(Operation{CsgOp::unite, 2}), node_with(Operation{CsgOp::subtract, 2}),
                 node_with(box, turned * scaling({1.5, 1.5, 1.5})),
                 node_with(Solid{Sphere{}}, scaling({0.6, 0.6, 0.6})),
                 node_with(box, translation({1.2, 0.3, -1}) * turned)};
  scene.nodes[0].material = 0;
  scene.camera = PerspectiveCamera{{0.3, 0.4, -5}, {0, -0.05, 1}, {0, 1, 0}, 50};
  scene.lights = {AmbientLight{glm::dvec3(0.3)}, PointLight{{-4, 5, -6}, glm::dvec3(0.9)}};
  check(scene);
  return scene;
}

struct Rendered {
  std::vector<float> rgb;
  RayCounters counters;
};
Rendered rendered(const Scene& scene) {
  RenderSettings settings;
  settings.width = 64, settings.height = 48, settings.spp = 4;
  const World world(scene);
  Rendered all;
  for (std::uint32_t tile = 0; tile < tile_count({settings.width, settings.height}); ++tile) {
    const auto images = render_tile(world, settings, tile, all_passes, [] { return false; });
    for (const PassImage& image : *images) {
      all.rgb.insert(all.rgb.end(), image.rgb.begin(), image.rgb.end());
      all.counters += image.counters;
    }
  }
  return all;
}

TEST(FacetsRender, AMeshOfACubeIsTheCube) {
  for (const bool of_glass : {false, true}) {
    const Rendered cube = rendered(scene_with(Cube{}, {}, of_glass));
    const Rendered mesh = rendered(scene_with(Mesh{0, false}, {asset_with(cube_mesh())}, of_glass));
    ASSERT_EQ(cube.rgb.size(), mesh.rgb.size());
    int different = 0;
    for (std::size_t i = 0; i < cube.rgb.size(); ++i)
      different += std::fabs(cube.rgb[i] - mesh.rgb[i]) > 1e-4f;
    EXPECT_LE(different, 3) << of_glass;  // a ray along an edge may go either way
    EXPECT_EQ(mesh.counters.lost, 0u);
    EXPECT_EQ(mesh.counters.bad_samples, 0u);
  }
}

TEST(FacetsRender, NoRayIsLostInGlassOfTrianglesAndPatches) {
  const Rendered ball = rendered(scene_with(Mesh{0, false}, {asset_with(ball_mesh(12, 18))}, true));
  EXPECT_EQ(ball.counters.lost, 0u);
  const Rendered patches = rendered(scene_with(Bezier{0}, {asset_with(ball_grid())}, true));
  EXPECT_EQ(patches.counters.lost, 0u);
  EXPECT_GT(patches.counters.refracted, 1000u);
}

TEST(FacetsRender, NoRayIsLostWhereShadingNormalsLeanOver) {
  Scene scene = scene_with(Mesh{0, true}, {asset_with(ball_mesh(5, 6))}, true);
  scene.nodes.erase(scene.nodes.begin() + 4);  // the other ball, which overlaps
  scene.nodes[0].content = Operation{CsgOp::unite, 1};
  EXPECT_EQ(rendered(scene).counters.lost, 0u);
}

/// A box of mirrors with the normals of a ball, and a ring through it.
TEST(FacetsRender, NoRayIsLostInsideOtherSolidsWhereShadingNormalsLeanOver) {
  Scene scene;
  scene.assets = {asset_with(cube_mesh())};
  scene.materials.push_back({{0.2, 0.2, 0.9}, 0.1, 0.3, 0.6, 16, 0, 1, 0});
  scene.materials.push_back({{0.9, 0.9, 0.9}, 0.1, 0.1, 0.4, 16, 0.4, 1.5, 0});
  const Affine turned = rotation_deg(0, 30) * rotation_deg(1, 50) * translation({-0.5, -0.5, -0.5});
  scene.nodes = {node_with(Operation{CsgOp::unite, 2}), node_with(Solid{Mesh{0, true}}, turned),
                 node_with(Solid{Torus{0.5, 0.2}}, translation({0, 0, 0}))};
  scene.camera = PerspectiveCamera{{0, 0, -3}, {0, 0, 1}, {0, 1, 0}, 40};
  scene.lights = {AmbientLight{glm::dvec3(0.5)}, PointLight{{3, 4, -5}, glm::dvec3(0.5)}};
  for (const std::uint32_t material : {0u, 1u}) {
    scene.nodes[0].material = material;
    check(scene);
    const Rendered all = rendered(scene);
    EXPECT_EQ(all.counters.lost, 0u) << material;
    EXPECT_GT(all.counters.reflected, 1000u) << material;
  }
}

TEST(FacetsRender, ASheetInAUnionShowsBothSidesAndLosesNoRay) {
  Scene scene;
  scene.assets = {asset_with(hill_grid())};
  scene.materials.push_back({{0.2, 0.5, 0.9}, 0.1, 0.3, 0.4, 16, 0.5, 1.5, 1});
  scene.nodes = {node_with(Operation{CsgOp::unite, 2}), node_with(Solid{Bezier{0}}, rotation_deg(0, 70)),
                 node_with(Solid{Sphere{}}, scaling({0.5, 0.5, 0.5}))};
  scene.nodes[0].material = 0;
  scene.camera = PerspectiveCamera{{0.3, 3, -5}, {0, -0.6, 1}, {0, 1, 0}, 60};
  scene.lights = {AmbientLight{glm::dvec3(0.3)}, PointLight{{-4, 5, -6}, glm::dvec3(0.9)}};
  check(scene);
  const Rendered sheet = rendered(scene);
  EXPECT_EQ(sheet.counters.lost, 0u);
  EXPECT_GT(sheet.counters.primary_hits, 100u);
}

TEST(FacetsRender, ScalesByPowersOfTwoKeepAllBits) {
  const auto scaled_ball = [](double scale) {
    TriangleMesh mesh = ball_mesh(8, 12);
    for (Vec3d& p : mesh.points) p = p * scale;
    Scene scene = scene_with(Mesh{0, true}, {asset_with(mesh)}, true);
    for (Node& node : scene.nodes) node.parent_from_node.offset *= scale;
    scene.nodes[3].parent_from_node.linear *= scale;
    auto& camera = std::get<PerspectiveCamera>(scene.camera);
    camera.from *= scale;
    std::get<PointLight>(scene.lights[1]).at *= scale;
    return rendered(scene).rgb;
  };
  const std::vector<float> one = scaled_ball(1);
  EXPECT_EQ(scaled_ball(1024), one);
  EXPECT_EQ(scaled_ball(1.0 / 1048576), one);
}

}  // namespace
}  // namespace rayfarm
