#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/reference/reference_torus.h"
#include "tests/reference/reference_tracer.h"
#include "tests/support/random_scene.h"
#include "tests/support/solid_definitions.h"

namespace rayfarm {
namespace {

using reference::Ray;
using reference::Real;
using reference::Spans;
using reference::Vec;

constexpr double pi = 3.14159265358979323846;

Affine at(double x, double y, double z) { return {glm::dmat3(1.0), {x, y, z}}; }
Affine scaled(double x, double y, double z) { return {glm::dmat3(x, 0, 0, 0, y, 0, 0, 0, z), glm::dvec3(0)}; }

Node leaf(const Solid& solid, const Affine& parent_from_node = {}) {
  Node node;
  node.content = solid;
  node.parent_from_node = parent_from_node;
  return node;
}
Node operation(CsgOp op, std::uint32_t children) {
  Node node;
  node.content = Operation{op, children};
  return node;
}

/// Seen from (0, 0, -5) towards +z, without lights unless given.
Scene scene_of(std::vector<Node> nodes, const Material& material = {}) {
  Scene scene;
  scene.nodes = std::move(nodes);
  scene.materials = {material};
  scene.nodes[0].material = 0;
  scene.camera = PerspectiveCamera{.from = {0, 0, -5}};
  scene.background = {0.25, 0.5, 1};
  return scene;
}

Material plain(double ambient, double diffuse, double specular, double transmission) {
  return {{1, 0.5, 0.25}, ambient, diffuse, specular, 16, transmission, 1.5, 0};
}

std::vector<double> crossings(const Scene& scene, const Ray& ray) {
  std::vector<double> ts;
  for (const auto& c : reference::spans_of(scene, reference::leaves_of(scene), ray).crossings)
    ts.push_back(static_cast<double>(c.t));
  return ts;
}
std::vector<double> crossings(const Solid& solid, const Ray& ray) {
  return crossings(scene_of({leaf(solid)}), ray);
}

glm::dvec3 centre_color(const Scene& scene, ReferenceSettings settings = {}) {
  return ReferenceTracer(scene).sample(settings, settings.width / 2, settings.height / 2).color;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}
void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}

// Solids.
// ------------------------------------------------------------------------------------------------------

TEST(ReferenceSolids, ARayCrossesEachSolidWhereSchoolGeometrySays) {
  const Ray z{{0, 0, -5}, {0, 0, 1}}, x{{-5, 0.25, 0.5}, {2, 0, 0}};
  expect_near(crossings(Sphere{}, z), {4, 6}, 1e-15);
  expect_near(crossings(Cube{}, x), {2.5, 3}, 1e-15);
  expect_near(crossings(Cylinder{-0.5, 0.75}, z), {4.5, 5.75}, 1e-15);
  expect_near(crossings(Cylinder{}, x), {2.5 - std::sqrt(0.9375) / 2, 2.5 + std::sqrt(0.9375) / 2}, 1e-15);
  expect_near(crossings(Plane{}, z), {5}, 1e-15);
  expect_near(crossings(Torus{2, 0.5}, Ray{{-9, 0, 0}, {1, 0, 0}}), {6.5, 7.5, 10.5, 11.5}, 1e-15);
  expect_near(crossings(Torus{2, 0.5}, Ray{{2, 0, -9}, {0, 0, 1}}), {8.5, 9.5}, 1e-15);
  EXPECT_TRUE(crossings(Torus{2, 0.5}, z).empty());
}

TEST(ReferenceSolids, ARayAlongAnInfiniteCylinderOrAPlaneIsInsideAllTheWayOrNotAtAll) {
  const Ray z{{0.5, 0, -5}, {0, 0, 1}}, above{{0, 0, 1}, {1, 1, 0}}, below{{0, 0, -1}, {1, 1, 0}};
  const auto starts_inside = [](const Solid& solid, const Ray& ray) {
    const Spans spans = reference::spans_of(solid, ray);
    EXPECT_TRUE(spans.crossings.empty());
    return spans.starts_inside;
  };
  EXPECT_TRUE(starts_inside(Cylinder{}, z));
  EXPECT_FALSE(starts_inside(Cylinder{}, Ray{{1.5, 0, 0}, {0, 0, 1}}));
  EXPECT_TRUE(starts_inside(Plane{}, below));
  EXPECT_FALSE(starts_inside(Plane{}, above));
}

TEST(ReferenceSolids, ASpindleTorusIsTheAppleWithoutTheLemon) {
  const double tip = std::sqrt(2.25 - 1);  // where the axis touches a torus of R = 1, r = 1.5
  expect_near(crossings(Torus{1, 1.5}, Ray{{-9, 0, 0}, {1, 0, 0}}), {6.5, 8.5, 9.5, 11.5}, 1e-15);
  EXPECT_EQ(crossings(Torus{1, 1.5}, Ray{{-9, 0, tip + 0.01}, {1, 0, 0}}).size(), 4u);  // through the dimple
  EXPECT_EQ(crossings(Torus{1, 1.5}, Ray{{-9, 0, tip - 0.01}, {1, 0, 0}}).size(), 4u);  // through the lemon
}

TEST(ReferenceSolids, ATorusKeepsItsFourCrossingsFromAnyDistance) {
  for (double distance = 1; distance < 1e12; distance *= 10)
    for (const double R : {1.0, 1.01, 1000.0})
      expect_near(crossings(Torus{R, 0.125}, Ray{{-R * distance, 0, 0}, {R * distance, 0, 0}}),
                  {1 - (1 + 0.125 / R) / distance, 1 - (1 - 0.125 / R) / distance,
                   1 + (1 - 0.125 / R) / distance, 1 + (1 + 0.125 / R) / distance},
                  1e-15);
}

// Set operations.
// ----------------------------------------------------------------------------------------------

TEST(ReferenceSpans, TwoHalfSpacesCanCoverTheWholeLine) {
  const Ray ray{{0, 0, -5}, {0, 0, 1}};
  const Scene all =
      scene_of({operation(CsgOp::unite, 2), leaf(Plane{}, at(0, 0, 1)), leaf(Plane{}, scaled(1, 1, -1))});
  const Spans spans = reference::spans_of(all, reference::leaves_of(all), ray);
  EXPECT_TRUE(spans.starts_inside);
  EXPECT_TRUE(spans.crossings.empty());
}

TEST(ReferenceSpans, CoincidentFacesLeaveNoSkin) {
  const Affine there{glm::dmat3(0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1), {0.1, 0.2, 0.3}};
  const Affine back{glm::transpose(there.linear), -(glm::transpose(there.linear) * there.offset)};
  for (const CsgOp op : {CsgOp::subtract, CsgOp::exclusive_or}) {
    const Scene scene =
        scene_of({operation(op, 2), leaf(Cube{}), operation(CsgOp::unite, 1), leaf(Cube{}, back)});
    Scene moved = scene;
    moved.nodes[2].parent_from_node = there;
    for (double y = 0.01; y < 1; y += 0.07)
      EXPECT_TRUE(crossings(moved, Ray{{-3, y, 0.4}, {1, 0.1, 0.05}}).empty());
  }
}

// Implicit functions (solid_definitions.h): a second opinion on where the inside is, for whole trees.
bool contains(const Scene& scene, std::size_t& node, const std::vector<reference::Leaf>& leaves, int& number,
              const Vec& p) {
  const auto* op = std::get_if<Operation>(&scene.nodes[node++].content);
  if (op == nullptr) {
    const reference::Leaf& l = leaves[number++];
    return contains(l.solid, l.local_from_world * (p - l.offset));
  }
  bool inside = false;
  for (std::uint32_t child = 0; child < op->children; ++child) {
    const bool next = contains(scene, node, leaves, number, p);
    switch (op->op) {
      case CsgOp::unite:
        inside = inside || next;
        break;
      case CsgOp::intersect:
        inside = child == 0 ? next : inside && next;
        break;
      case CsgOp::subtract:
        inside = child == 0 ? next : inside && !next;
        break;
      case CsgOp::exclusive_or:
        inside = inside != next;
        break;
    }
  }
  return inside;
}

void expect_spans_agree_with_points(const Scene& scene, std::uint64_t seed) {
  const auto leaves = reference::leaves_of(scene);
  for (int i = 0; i < 40; ++i) {
    const Real angle = 0.37L * i + seed;
    const Ray ray{{5 * std::cos(angle), std::sin(2.1L * angle), 5 * std::sin(angle)},
                  {-std::cos(angle + 0.2L), 0.3L * std::sin(angle), -std::sin(angle + 0.1L)}};
    const Spans spans = reference::spans_of(scene, leaves, ray);
    bool inside = spans.starts_inside;
    std::size_t passed = 0;
    for (Real t = -20.123L; t < 20; t += 0.217L) {
      for (; passed < spans.crossings.size() && spans.crossings[passed].t < t; ++passed) {
        inside = !inside;
        EXPECT_EQ(inside, spans.crossings[passed].entering);
      }
      std::size_t node = 0;
      int number = 0;
      ASSERT_EQ(inside, contains(scene, node, leaves, number, ray.origin + t * ray.direction))
          << "scene " << seed << ", ray " << i << ", t " << double(t);
    }
  }
}

TEST(ReferenceSpans, APointOfTheLineIsInsideIffTheTreesImplicitFunctionsSaySo) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) expect_spans_agree_with_points(random_scene(seed), seed);
  for (std::uint64_t seed = 0; seed < 200; ++seed)
    expect_spans_agree_with_points(random_snapped_scene(seed), seed);
}

// Surfaces.
// ----------------------------------------------------------------------------------------------------

TEST(ReferenceTracer, TheNormalPointsOutOfTheMaterialAlsoWhereItIsCutOutOrMirrored) {
  const Scene hollow =
      scene_of({operation(CsgOp::subtract, 2), leaf(Sphere{}), leaf(Sphere{}, at(0, 0, -1))});
  const auto dent = ReferenceTracer(hollow).first_hit({0, 0, -5}, {0, 0, 1});
  ASSERT_TRUE(dent);
  EXPECT_DOUBLE_EQ(dent->distance, 5);
  EXPECT_EQ(dent->leaf, 1);
  expect_near(dent->normal, {0, 0, -1}, 1e-15);

  const Scene mirrored = scene_of({leaf(Sphere{}, scaled(2, 1, -3))});
  const auto side = ReferenceTracer(mirrored).first_hit({1, 0, -5}, {0, 0, 1});
  ASSERT_TRUE(side);
  expect_near(side->point, {1, 0, -3 * std::sqrt(0.75)}, 1e-15);
  expect_near(side->normal, glm::normalize(glm::dvec3(0.25, 0, -std::sqrt(0.75) / 3)), 1e-15);

  const Scene inside = scene_of({leaf(Sphere{}, scaled(9, 9, 9))});
  const auto exit = ReferenceTracer(inside).first_hit({0, 0, 0}, {0, 0, 1});
  ASSERT_TRUE(exit);
  expect_near(exit->normal, {0, 0, 1}, 1e-15);
}

TEST(ReferenceTracer, AColorAboveBeatsAMaterialBelow) {
  Scene scene = scene_of({operation(CsgOp::unite, 1), leaf(Sphere{})});
  scene.materials.push_back(plain(0, 0, 0, 0));
  scene.nodes[1].material = 1;
  expect_near(centre_color(scene), {1, 0.5, 0.25}, 0);
  scene.nodes[0].color = glm::dvec3(0.1, 0.2, 0.3);
  expect_near(centre_color(scene), {0.1, 0.2, 0.3}, 1e-16);
  scene.nodes[1].color = glm::dvec3(0.4, 0.5, 0.6);
  expect_near(centre_color(scene), {0.4, 0.5, 0.6}, 1e-16);
}

TEST(ReferenceTracer, ACheckersCellsAreOneOverFWideOnAPlane) {
  Scene scene = scene_of({leaf(Plane{}, scaled(1, 1, -1))}, plain(0, 0, 0, 0));
  scene.nodes[0].textures = {Checker{2, 0.5, {0, 0, 0}}};
  scene.camera = PerspectiveCamera{.from = {0.1, 0.1, -5}, .angle_deg = 90};
  const ReferenceTracer tracer(scene);
  const auto is_odd_at = [&](double x,
                             double y) {  // the film of side 10 shows (x, y) 5 units away at scale 1
    const ReferenceSettings film{.width = 10, .height = 10};
    return tracer.sample(film, 5 + (x - 0.1), 5 - (y - 0.1)).color == glm::dvec3(0);
  };
  EXPECT_FALSE(is_odd_at(0.25, 1));
  EXPECT_TRUE(is_odd_at(0.75, 1));
  EXPECT_TRUE(is_odd_at(-0.25, 1));
  EXPECT_FALSE(is_odd_at(-0.25, -1));
  EXPECT_TRUE(is_odd_at(0.25, 3));
}

// Light.
// -------------------------------------------------------------------------------------------------------

TEST(ReferenceTracer, ALightStraightAheadGivesAllOfItsDiffuseAndSpecularPart) {
  Scene scene = scene_of({leaf(Plane{}, scaled(1, 1, -1))}, plain(0.1, 0.6, 0.04, 0));
  scene.lights = {AmbientLight{glm::dvec3(0.5)}, PointLight{{0, 0, -7}, glm::dvec3(2)}};
  expect_near(centre_color(scene), 0.05 * glm::dvec3(1, 0.5, 0.25) + 1.2 * glm::dvec3(1, 0.5, 0.25) + 0.08,
              1e-15);
}

TEST(ReferenceTracer, ALightBehindTheSurfaceGivesNothingAndAThingBetweenBlocksIt) {
  Scene scene = scene_of({operation(CsgOp::unite, 2), leaf(Plane{}, scaled(1, 1, -1)),
                          leaf(Sphere{}, Affine{glm::dmat3(0.1), {0.5, 0, -0.5}})},
                         plain(0, 1, 0, 0));
  const auto lit_from = [&](const glm::dvec3& light) {
    scene.lights = {PointLight{light, glm::dvec3(1)}};
    return centre_color(scene).r > 0;
  };
  EXPECT_TRUE(lit_from({-3, 0, -3}));
  EXPECT_FALSE(lit_from({-3, 0, 3}));
  EXPECT_FALSE(lit_from({3, 0, -3}));
  EXPECT_TRUE(lit_from({0.25, 0, -0.25}));  // in front of the small sphere
}

TEST(ReferenceTracer, ARectangleLightIsDimmedByDistance) {
  Scene scene = scene_of({leaf(Plane{}, scaled(1, 1, -1))}, plain(0, 1, 0.04, 0));
  scene.lights = {PointLight{{0.25, 3, -4}, glm::dvec3(1)}};
  const glm::dvec3 undimmed = centre_color(scene);
  scene.lights = {RectangleLight{{0, 3, -5}, {1, 0, 0}, {0, 0, 4}, glm::dvec3(1), {0.5, 1, 0.1}}};
  ReferenceSettings settings;
  settings.light_uv = {0.25, 0.25};
  const double s = std::sqrt(0.0625 + 9 + 16);
  expect_near(centre_color(scene, settings), undimmed / (0.5 + s + 0.1 * s * s), 1e-15);
}

TEST(ReferenceTracer, AMirrorAtFortyFiveDegreesWeighsBySchlick) {
  Scene scene = scene_of({leaf(Plane{}, Affine{glm::dmat3(1, 0, 0, 0, 1, 1, 0, -1, -1), {0, 0, 0}})},
                         {{1, 1, 1}, 0, 0.4, 0.5, 16, 0, 1.5, 1});
  scene.nodes[0].parent_from_node.linear =
      glm::dmat3(1, 0, 0, 0, std::sqrt(0.5), -std::sqrt(0.5), 0, -std::sqrt(0.5), -std::sqrt(0.5));
  scene.lights = {AmbientLight{glm::dvec3(0)}};
  const double w = std::pow(1 - std::sqrt(0.5), 5);
  expect_near(centre_color(scene), (0.5 + 0.4 * w) * scene.background, 1e-15);
}

TEST(ReferenceTracer, LightPassesAGlassPaneWithTheSquareOfItsTransmission) {
  Scene scene = scene_of({leaf(Cube{}, at(-0.5, -0.5, 0))}, plain(0.5, 0, 0, 0.75));
  scene.lights = {AmbientLight{glm::dvec3(1)}};
  const glm::dvec3 skin = 0.5 * glm::dvec3(1, 0.5, 0.25);
  expect_near(centre_color(scene), skin + 0.75 * (0.75 * skin + 0.75 * scene.background), 1e-15);
  scene.materials[0].transmission = 0.2;  // 0.2 * 0.2 is below the least importance
  expect_near(centre_color(scene), skin + 0.2 * 0.2 * skin, 1e-15);
}

TEST(ReferenceTracer, BeyondTheAngleOfTotalReflectionTheMirrorGetsWhatWouldHavePassed) {
  // In through a slanted face at right angles, then onto the face z = 0 from inside at 45 degrees and out
  // again.
  Scene scene = scene_of({operation(CsgOp::intersect, 2), leaf(Plane{}, scaled(1, 1, 1)),
                          leaf(Plane{}, Affine{glm::dmat3(1), {0, 0, 0}})},
                         plain(0, 0, 0.25, 0.5));
  const double h = std::sqrt(0.5);
  scene.nodes[2].parent_from_node = {glm::dmat3(1, 0, 0, 0, h, -h, 0, -h, -h), {0, 0, -4}};
  scene.camera = PerspectiveCamera{.from = {0, 0.5, -8.5}, .direction = {0, 1, 1}, .up = {1, 0, 0}};
  scene.lights = {AmbientLight{glm::dvec3(0)}};
  ReferenceSettings settings;
  settings.max_depth = 2;
  const auto hit = ReferenceTracer(scene).first_hit({0, 0.5, -8.5}, {0, 1, 1});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->leaf, 1);
  expect_near(hit->normal, {0, -h, -h}, 1e-15);
  // Mirror on entering, then through: kt * (ks + kt) * what the last ray sees (nothing but black inside).
  scene.background = {1, 1, 1};
  settings.min_importance = 0;
  expect_near(centre_color(scene, settings), glm::dvec3(0.25 + 0.5 * (0.25 + 0.5) * 1.0), 1e-15);
}

TEST(ReferenceTracer, ADepthOfNAllowsNSecondaryRays) {
  Scene scene =
      scene_of({operation(CsgOp::unite, 2), leaf(Plane{}, at(0, 0, -9)), leaf(Plane{}, scaled(1, 1, -1))},
               plain(1, 0, 0.5, 0));
  scene.lights = {AmbientLight{glm::dvec3(1)}};
  ReferenceSettings settings;
  settings.min_importance = 0;
  double sum = 0;
  for (settings.max_depth = 0; settings.max_depth < 14; ++settings.max_depth) {
    sum += std::ldexp(1.0, -settings.max_depth);
    expect_near(centre_color(scene, settings), sum * glm::dvec3(1, 0.5, 0.25), 1e-15);
  }
  EXPECT_LT(centre_color(scene).r, 2 - 1.0 / 32);  // 0.5^5 is below the least importance
}

TEST(ReferenceTracer, ASceneOfAnotherSizeLooksTheSame) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = random_scene(seed);
    Scene small = scene;
    const double k = std::ldexp(1.0, -30);
    small.nodes[0].parent_from_node.linear *= k;
    small.nodes[0].parent_from_node.offset *= k;
    auto& camera = std::get<PerspectiveCamera>(small.camera);
    camera.from *= k;
    for (Light& light : small.lights) {
      if (auto* point = std::get_if<PointLight>(&light)) point->at *= k;
      if (auto* area = std::get_if<RectangleLight>(&light))
        area->at *= k, area->width *= k, area->height *= k, area->dim /= glm::dvec3(1, k, k * k);
    }
    const ReferenceSettings film{.width = 12, .height = 9};
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 12; ++x)
        expect_near(ReferenceTracer(small).sample(film, x + 0.5, y + 0.5).color,
                    ReferenceTracer(scene).sample(film, x + 0.5, y + 0.5).color, 1e-12);
  }
}

}  // namespace
}  // namespace rayfarm
