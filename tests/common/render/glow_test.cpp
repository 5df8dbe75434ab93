// Glow shells, and solids that cast no shadow.
#include <gtest/gtest.h>

#include <cmath>

#include "common/render/probe.h"
#include "common/render/world_parts.h"

namespace rayfarm {
namespace {

Node node(const NodeContent& content, const Affine& parent_from_node = {}) {
  Node n;
  n.content = content, n.parent_from_node = parent_from_node;
  return n;
}

/// Seen from (x, y, -5) towards +z in parallel rays, two pixels of one unit.
Scene scene_of(std::vector<Node> parts) {
  Scene scene;
  scene.nodes = {node(Operation{CsgOp::unite, static_cast<std::uint32_t>(parts.size())})};
  scene.nodes.insert(scene.nodes.end(), parts.begin(), parts.end());
  scene.camera = OrthographicCamera{.from = {0, 0, -5}, .width = 2};
  scene.background = {0.25, 0.5, 1};
  return scene;
}

RenderSettings film() {
  RenderSettings s;
  s.width = s.height = 2;
  s.reflections = s.refractions = false;
  return s;
}

/// What is seen of the scene from (x, y), both from -1 to 1.
Probe seen_at(const Scene& scene, double x, double y) {
  return probe(World(scene), film(), x + 1, 1 - y, {0, 0});
}
glm::dvec3 color_at(const Scene& scene, double x, double y) { return seen_at(scene, x, y).color; }

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-14);
}

constexpr glm::dvec3 glowing{0.5, 2, 0.125};

TEST(Glow, FallsWithTheSineOfTheAngleFromTheMiddleToTheRim) {
  for (const std::uint32_t exponent : {0u, 1u, 16u}) {
    const Scene scene = scene_of({node(Glow{Sphere{}, glowing, exponent})});
    for (const double x : {0.0, 0.1, -0.5, 0.99})
      expect_near(color_at(scene, x, 0.01),
                  scene.background + glowing * std::pow(1 - std::hypot(x, 0.01), exponent));
  }
}

TEST(Glow, OfATubeIsThatOfItsCrossSectionAndEndsWithIt) {
  const Affine upright = rotation_deg(0, -90);  // local z is world y
  const Scene scene = scene_of({node(Glow{Cylinder{-0.5, 0.25}, glowing, 4}, upright)});
  for (const double x : {0.0, -0.25, 0.75}) {
    const glm::dvec3 lit = scene.background + glowing * std::pow(1 - std::fabs(x), 4);
    expect_near(color_at(scene, x, 0.2), lit);
    expect_near(color_at(scene, x, -0.45), lit);
    expect_near(color_at(scene, x, 0.3), scene.background);
    expect_near(color_at(scene, x, -0.55), scene.background);
  }
  // Along the axis there is only an opening.
  expect_near(color_at(scene_of({node(Glow{Cylinder{-1, 1}, glowing, 4})}), 0.1, 0.2), scene.background);
}

TEST(Glow, IsSeenInFrontOfSurfacesAndOnThemButNotBehind) {
  const glm::dvec3 red{1, 0, 0};
  const auto with_ball = [&](double glow_radius) {
    Node ball = node(Sphere{});
    ball.color = red;
    return scene_of({ball, node(Glow{Sphere{}, glowing, 1}, scaling(glm::dvec3(glow_radius)))});
  };
  for (const double x : {0.0, 0.3, -0.6}) {
    expect_near(color_at(with_ball(2), x, 0.1), red + glowing * (1 - std::hypot(x, 0.1) / 2));
    expect_near(color_at(with_ball(1), x, 0.1), red + glowing * (1 - std::hypot(x, 0.1)));
    expect_near(color_at(with_ball(0.99), x, 0.1), red);
  }
}

TEST(Glow, OfAllShellsOnTheWayAddsUpAndMakesNoSurface) {
  const Scene scene = scene_of({node(Glow{Sphere{}, glowing, 2}, translation({0, 0, 3})),
                                node(Glow{Sphere{}, glowing, 2}), node(Sphere{}, translation({0, 0, 9}))});
  EXPECT_EQ(World(scene).parts().leaves.size(), 1u);
  const Probe seen = seen_at(scene, 0.5, 0);
  EXPECT_NEAR(seen.first_hit->distance, 14 - std::sqrt(0.75), 1e-14);
  expect_near(seen.color, Material{}.color + 2.0 * glowing * 0.25);
}

TEST(Glow, IsNotSeenFromWithin) {
  Scene scene = scene_of({node(Glow{Sphere{}, glowing, 1})});
  std::get<OrthographicCamera>(scene.camera).from.z = 0;
  EXPECT_EQ(color_at(scene, 0.1, 0.1), scene.background);
}

TEST(Glow, OnASurfaceIsNotSeenByRaysThatLeaveTheSurface) {
  // A mirror in a shell of its own size, turned so that their numbers differ by rounding.
  const Affine turned = rotation_deg(0, 33) * rotation_deg(1, 77) * scaling(glm::dvec3(0.7));
  Node mirror = node(Sphere{}, scaling(glm::dvec3(0.7)));
  mirror.color = glm::dvec3(0.0), mirror.material = 0;
  Scene scene = scene_of({mirror, node(Glow{Sphere{}, glowing, 3}, turned)});
  Material m;
  m.specular = 0.5, m.schlick = 0, m.transmission = 0.25, m.index = 1;
  scene.materials = {m};
  scene.lights = {AmbientLight{glm::dvec3(0.0)}};
  RenderSettings s = film();
  s.reflections = s.refractions = true;
  const World world(scene);
  for (double x = -0.69; x < 0.69; x += 0.0137) {
    const double s_here = std::fabs(x) / 0.7;
    const glm::dvec3 mirrored = 0.5 * scene.background;
    const glm::dvec3 once = glowing * std::pow(1 - s_here, 3);
    const glm::dvec3 color = probe(world, s, x + 1, 1, {0, 0}).color - mirrored - once;
    // What comes through the ball and its inner reflections is more of the background, never of the shell.
    EXPECT_NEAR(color.x / color.z, scene.background.x / scene.background.z, 1e-12) << x;
  }
}

TEST(NoShadow, LetsLightPassButIsSeen) {
  Node ball = node(Sphere{}, translation({0, 0, -2}) * scaling(glm::dvec3(0.25)));
  const auto scene_with = [](const Node& n) {
    Scene scene = scene_of({node(Plane{}, scaling({1, 1, -1})), n});
    scene.lights = {PointLight{{-0.3, 0, -4}, glm::dvec3(1)}};
    return scene;
  };
  const double x = 0.3;  // of the floor behind the ball, as the light sees it
  EXPECT_EQ(color_at(scene_with(ball), x, 0), glm::dvec3(0));
  ball.no_shadow = true;
  EXPECT_GT(color_at(scene_with(ball), x, 0).r, 0.1);
  EXPECT_EQ(seen_at(scene_with(ball), 0, 0).first_hit->leaf, 1u);
}

TEST(NoShadow, IsInheritedAndLeavesOtherSurfacesOfTheObjectTheirShadow) {
  const Affine above = translation({-0.5, -0.5, -2});
  const auto is_dark = [&](bool whole, bool cube, bool ball) {
    Node difference = node(Operation{CsgOp::subtract, 2}, above);
    Node a = node(Cube{}), b = node(Sphere{}, scaling(glm::dvec3(0.25)));
    difference.no_shadow = whole, a.no_shadow = cube, b.no_shadow = ball;
    Scene scene = scene_of({difference, a, b});
    scene.nodes[0].content = Operation{CsgOp::unite, 1};
    const World world(scene);
    WorldWorkspace workspace;
    Ray ray;  // through the cube's middle, from the floor up
    ray.origin = {-0.1, -0.1, -0.5}, ray.direction = {0, 0, -3};
    EXPECT_EQ(is_blocked(world.parts(), RayQuery(ray), workspace),
              first_blocker(world.parts(), RayQuery(ray), workspace).has_value());
    return is_blocked(world.parts(), RayQuery(ray), workspace);
  };
  EXPECT_TRUE(is_dark(false, false, false));
  EXPECT_TRUE(is_dark(false, false, true));
  EXPECT_FALSE(is_dark(false, true, false));
  EXPECT_FALSE(is_dark(true, false, false));
}

}  // namespace
}  // namespace rayfarm
