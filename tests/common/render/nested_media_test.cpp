// Nested media: a boundary is wherever another material begins.
#include <gtest/gtest.h>

#include "common/render/hit.h"
#include "common/render/render.h"
#include "common/render/shade.h"
#include "tests/common/geometry/rays.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

Node leaf(const Solid& solid, const Affine& map, std::uint32_t material) {
  return {solid, map, material, {}, {}, {}};
}
Node inner(CsgOp op, std::uint32_t children) { return {Operation{op, children}, {}, {}, {}, {}, {}}; }

Material glass_of(double index) {
  Material m;
  m.ambient = 0, m.diffuse = 0, m.specular = 0, m.schlick = 0, m.transmission = 1, m.index = index;
  return m;
}

/// A ball of glass (material 0) with a core of water (material 1) about (0, 0, 5).
Scene ball_with_core() {
  Scene scene;
  scene.nodes = {inner(CsgOp::unite, 2), leaf(Sphere{}, translation({0, 0, 5}), 0),
                 leaf(Sphere{}, translation({0, 0, 5}) * scaling({0.5, 0.5, 0.5}), 1)};
  scene.materials = {glass_of(1.5), glass_of(1.33)};
  scene.background = {1, 0, 0};
  scene.nested_media = true;
  return scene;
}

std::optional<Hit> hit_of(const World& world, const Ray& ray, WorldWorkspace& workspace) {
  const RayQuery query(ray);
  const auto boundary = first_boundary(world.parts(), query, workspace);
  if (!boundary) return std::nullopt;
  return hit_at(world.parts(), query, *boundary);
}

struct Passed {
  std::uint32_t from, into;  // media
  double index;
  bool operator==(const Passed&) const = default;
};

/// What a ray passes that goes straight on.
std::vector<Passed> passed_by(const World& world, Ray ray) {
  WorldWorkspace workspace;
  std::vector<Passed> passed;
  while (const auto hit = hit_of(world, ray, workspace)) {
    passed.push_back(
        {hit->entering ? hit->outer : hit->inner, hit->entering ? hit->inner : hit->outer, hit->index});
    EXPECT_FALSE(contradicts(ray, *hit));
    ray = ray_from(*hit, ray.direction, !hit->entering);
  }
  return passed;
}

Ray ray_of(const Vec3d& origin, const Vec3d& direction) {
  Ray ray;
  ray.origin = origin, ray.direction = direction;
  return ray;
}

TEST(NestedMedia, ARayPassesEachChangeOfMaterial) {
  const std::vector<Passed> expected{
      {empty_space, 0, 1.5}, {0, 1, 1.33 / 1.5}, {1, 0, 1.33 / 1.5}, {0, empty_space, 1.5}};
  EXPECT_EQ(passed_by(World(ball_with_core()), ray_of({0, 0, 0}, {0, 0, 1})), expected);
}

TEST(NestedMedia, ACameraMayStandInASolid) {
  const std::vector<Passed> expected{{1, 0, 1.33 / 1.5}, {0, empty_space, 1.5}};
  EXPECT_EQ(passed_by(World(ball_with_core()), ray_of({0, 0, 5}, {0, 0, 1})), expected);
}

TEST(NestedMedia, WhatIsWrittenLaterFillsThePlace) {
  Scene scene = ball_with_core();
  std::swap(scene.nodes[1], scene.nodes[2]);  // all of the core is overlapped by the later ball
  const std::vector<Passed> expected{{empty_space, 0, 1.5}, {0, empty_space, 1.5}};
  EXPECT_EQ(passed_by(World(scene), ray_of({0, 0, 0}, {0, 0, 1})), expected);
}

TEST(NestedMedia, SolidsOfOneMaterialAreOne) {
  Scene scene = ball_with_core();
  scene.nodes[2].material = 0;
  EXPECT_EQ(passed_by(World(scene), ray_of({0, 0, 0}, {0, 0, 1})).size(), 2u);
}

TEST(NestedMedia, WaterFillsAGlassToItsWall) {
  // A cup whose hole is just what the water fills: the faces coincide.
  Scene scene = ball_with_core();
  const Affine at = translation({0, 0, 5}), core = at * scaling({0.5, 0.5, 0.5});
  scene.nodes = {inner(CsgOp::unite, 2), inner(CsgOp::subtract, 2), leaf(Sphere{}, at, 0),
                 leaf(Sphere{}, core, 0), leaf(Sphere{}, core, 1)};
  const std::vector<Passed> expected{
      {empty_space, 0, 1.5}, {0, 1, 1.33 / 1.5}, {1, 0, 1.33 / 1.5}, {0, empty_space, 1.5}};
  EXPECT_EQ(passed_by(World(scene), ray_of({0.1, 0.2, 0}, {0, 0, 1})), expected);
}

TEST(NestedMedia, ARayInADenserMediumIsTotallyReflectedAtABubble) {
  // From the glass around, past the critical angle of glass and water: arcsin(1.33 / 1.5) = 62.5 degrees.
  const World world(ball_with_core());
  WorldWorkspace workspace;
  for (const double height : {0.44, 0.45}) {  // of the core's 0.5: angles of 61.6 and 64.2 degrees
    const auto hit = hit_of(world, ray_of({0, height, 4.2}, {0, 0, 1}), workspace);
    ASSERT_TRUE(hit && hit->entering);
    EXPECT_EQ(refracted({0, 0, -1}, hit->normal, hit->index).has_value(), height == 0.44);
  }
}

/// What fills a point, by the definition: of the leaves that hold it, the last, but none that is subtracted.
class Membership {
 public:
  Membership(const Scene& scene, const World::Parts& world) : scene_(scene), world_(world) {}

  std::uint32_t medium_at(const Vec3d& p) const {
    std::uint32_t node = 0, leaf = 0;
    const std::optional<std::uint32_t> filling = filling_at(p, node, leaf);
    return filling ? world_.surfaces[*filling].material : empty_space;
  }

 private:
  std::optional<std::uint32_t> filling_at(const Vec3d& p, std::uint32_t& node, std::uint32_t& leaf) const {
    const auto* operation = std::get_if<Operation>(&scene_.nodes[node++].content);
    if (!operation) {
      Ray r = ray_of(p, {0.5, 0.6, 0.7});  // any ray knows the side at its origin
      const Leaf& l = world_.leaves[leaf];
      const std::uint32_t number = leaf++;
      return crossings(l, RayQuery(r)).starts_inside ? std::optional(number) : std::nullopt;
    }
    std::optional<std::uint32_t> first, last;
    std::uint32_t holding = 0;
    for (std::uint32_t i = 0; i < operation->children; ++i) {
      const auto child = filling_at(p, node, leaf);
      if (i == 0) first = child;
      if (child) last = child, ++holding;
    }
    if (operation->op == CsgOp::intersect) return holding == operation->children ? last : std::nullopt;
    if (operation->op == CsgOp::subtract) return holding == 1 ? first : std::nullopt;
    return operation->op == CsgOp::unite || holding % 2 == 1 ? last : std::nullopt;
  }

  const Scene& scene_;
  const World::Parts& world_;
};

TEST(NestedMedia, APlaceIsFilledByTheLastLeafThatHoldsIt) {
  RandomRays random(5);
  int pieces = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Scene scene = seed % 2 ? random_scene(seed) : random_snapped_scene(seed);
    scene.nested_media = true;
    const World world(scene);
    const Membership membership(scene, world.parts());
    WorldWorkspace workspace;
    for (int i = 0; i < 50; ++i) {
      Ray ray = random.towards_box(8, 2);
      while (const auto hit = hit_of(world, ray, workspace)) {
        EXPECT_FALSE(contradicts(ray, *hit)) << seed;
        if (hit->t > 1e-6) {
          const Vec3d middle = ray.origin + ray.direction * (0.5 * hit->t);
          ASSERT_EQ(membership.medium_at(middle), hit->entering ? hit->outer : hit->inner) << seed;
          ++pieces;
        }
        ray = ray_from(*hit, ray.direction, !hit->entering);
      }
    }
  }
  EXPECT_GT(pieces, 3'000);
}

TEST(NestedMedia, NoRayIsLost) {
  RenderSettings settings;
  settings.width = settings.height = 64, settings.spp = 1, settings.min_importance = 0.01;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Scene scene = seed % 2 ? random_scene(seed) : random_snapped_scene(seed);
    scene.nested_media = true;
    RayCounters counters;
    const auto images = render_tile(World(scene), settings, 0, all_passes, [] { return false; });
    for (const PassImage& image : *images) counters += image.counters;
    EXPECT_EQ(counters.lost, 0u) << seed;
  }
}

TEST(NestedMedia, WhereNothingOverlapsThePictureIsThatWithout) {
  Scene scene = ball_with_core();
  scene.nodes[2].parent_from_node = translation({2.5, 0, 5});
  for (Material& m : scene.materials) m.specular = 0.3, m.diffuse = 0.4;
  scene.lights = {PointLight{{3, 4, -2}, glm::dvec3(1)}};
  RenderSettings settings;
  settings.width = settings.height = 64, settings.spp = 4;
  const auto images = [&](bool nested) {
    scene.nested_media = nested;
    return render_tile(World(scene), settings, 0, all_passes, [] { return false; });
  };
  EXPECT_EQ(images(true), images(false));
}

}  // namespace
}  // namespace rayfarm
