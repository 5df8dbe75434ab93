// Rays that were sent to one side of the material and met what only the other side has.
#include <gtest/gtest.h>

#include "common/render/render.h"
#include "common/render/world_parts.h"
#include "tests/support/moved_scene.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

const auto never = [] { return false; };

RayCounters counters_of(const Scene& scene) {
  RenderSettings s;
  s.width = 64, s.height = 64, s.spp = 1, s.min_importance = 0.01;
  RayCounters counters;
  const auto images = render_tile(World(scene), s, 0, all_passes, never);
  for (const PassImage& image : *images) counters += image.counters;
  return counters;
}

TEST(LostRays, ThereAreNoneAlsoWhereFacesCoincide) {
  std::uint64_t sent = 0;
  for (Scene (*make)(std::uint64_t) :
       {random_scene, random_snapped_scene, random_special_scene, random_faceted_scene})
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      const RayCounters c = counters_of(make(seed));
      EXPECT_EQ(c.lost, 0u) << seed;
      sent += c.reflected + c.refracted;
    }
  EXPECT_GT(sent, 100'000u);
}

TEST(LostRays, AreCountedWhereTheNumbersAreTooCoarse) {
  // Far away the numbers are too coarse to tell the sides of a thing apart.
  std::uint64_t lost = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RayCounters c = counters_of(shifted(random_scene(seed), 1e12 * glm::dvec3{1, 0.7, 0.3}));
    lost += c.lost;
    EXPECT_LE(c.lost, c.reflected + c.refracted);
  }
  EXPECT_GT(lost, 100u);
}

TEST(LostRays, ASideIsContradictedByTheWayASurfaceIsPassed) {
  EXPECT_TRUE(contradicts(Side::outside, false));
  EXPECT_TRUE(contradicts(Side::inside, true));
  EXPECT_FALSE(contradicts(Side::outside, true));
  EXPECT_FALSE(contradicts(Side::inside, false));
  EXPECT_FALSE(contradicts(Side::unknown, true));
  EXPECT_FALSE(contradicts(Side::unknown, false));
}

TEST(LostRays, EndlessMaterialMayHoldARayForEver) {
  Scene scene;
  scene.nodes = {{Operation{CsgOp::unite, 2}, {}, {}, {}, {}, ""},
                 {Plane{}, {}, {}, {}, {}, ""},
                 {Sphere{}, translation({0, 0, 5}), {}, {}, {}, ""}};
  const World world(scene);
  WorldWorkspace workspace;
  const auto ends = [&](const Vec3d& origin, const Vec3d& direction) {
    Ray ray;
    ray.origin = origin, ray.direction = direction;
    return ends_inside(world.parts(), RayQuery(ray), workspace);
  };
  EXPECT_TRUE(ends({0, 0, -1}, {1, 0, 0}));
  EXPECT_TRUE(ends({0, 0, 9}, {0, 1, -1}));
  EXPECT_FALSE(ends({0, 0, -1}, {1, 0, 1}));
  EXPECT_FALSE(ends({0, 0, 5}, {1, 0, 0}));
}

}  // namespace
}  // namespace rayfarm
