// What it takes to find what rays meet, counted.
#include <gtest/gtest.h>

#include "common/render/camera_rays.h"
#include "common/render/hit.h"
#include "common/render/world_parts.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

Ray ray_along(const Vec3d& origin, const Vec3d& direction) {
  Ray ray;
  ray.origin = origin, ray.direction = direction;
  return ray;
}

Scene scene_of(std::vector<Node> nodes) {
  Scene scene;
  scene.nodes = std::move(nodes);
  return scene;
}

RayTests tests_of(const Scene& scene, const Ray& ray) {
  CountingWorkspace workspace;
  first_boundary(World(scene).parts(), RayQuery(ray), workspace);
  return workspace.csg.tests;
}

TEST(RayTests, CountBoxesSolidsAndCrossings) {
  const Scene sphere = scene_of({{Sphere{}, {}, {}, {}, {}, ""}});
  EXPECT_EQ(tests_of(sphere, ray_along({0, 0, -5}, {0, 0, 1})), (RayTests{1, 1, 2}));
  EXPECT_EQ(tests_of(sphere, ray_along({0.9, 0.9, -5}, {0, 0, 1})), (RayTests{1, 1, 0}));
  EXPECT_EQ(tests_of(sphere, ray_along({0, 0, -5}, {0, 1, 0})), (RayTests{1, 0, 0}));

  const Scene plane =
      scene_of({{Plane{}, {}, {}, {}, {}, ""}});  // has no box; that of the empty hierarchy counts
  EXPECT_EQ(tests_of(plane, ray_along({0, 0, 5}, {0, 0, -1})), (RayTests{1, 1, 1}));

  const Scene half = scene_of({{Operation{CsgOp::subtract, 2}, {}, {}, {}, {}, ""},
                               {Sphere{}, {}, {}, {}, {}, ""},
                               {Cube{}, scaling({9, 9, 9}), {}, {}, {}, ""}});
  EXPECT_EQ(tests_of(half, ray_along({-0.5, -0.5, -5}, {0, 0, 1})),
            (RayTests{4, 1, 2}));  // misses the cube's box
}

TEST(RayTests, WhoCountsFindsTheSame) {
  for (Scene (*make)(std::uint64_t) :
       {random_scene, random_snapped_scene, random_special_scene, random_faceted_scene})
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const World world(make(seed));
      const CameraRays camera(world.scene().camera, {24, 24});
      WorldWorkspace plain;
      CountingWorkspace counting;
      for (int i = 0; i < 24 * 24; ++i) {
        const std::optional<Ray> ray = camera.ray(i % 24 + 0.5, i / 24 + 0.5);
        if (!ray) continue;
        const RayQuery query(*ray);
        const auto a = first_boundary(world.parts(), query, plain);
        const auto b = first_boundary(world.parts(), query, counting);
        ASSERT_EQ(a.has_value(), b.has_value());
        ASSERT_TRUE(!a || (a->t == b->t && a->leaf == b->leaf && a->entering == b->entering));
        ASSERT_EQ(is_blocked(world.parts(), query, plain), is_blocked(world.parts(), query, counting));
        if (!a) continue;
        const Hit hit = hit_at(world.parts(), query, *a);
        for (const bool outside : {true, false}) {
          const RayQuery next(
              ray_from(hit, hit.normal * (outside ? 1.0 : -1.0) + ray->direction * 0.3, outside));
          const auto c = first_boundary(world.parts(), next, plain);
          const auto d = first_boundary(world.parts(), next, counting);
          ASSERT_EQ(c.has_value(), d.has_value());
          ASSERT_TRUE(!c || (c->t == d->t && c->leaf == d->leaf && c->entering == d->entering));
        }
      }
      EXPECT_GT(counting.csg.tests.boxes, 0u);
    }
}

}  // namespace
}  // namespace rayfarm
