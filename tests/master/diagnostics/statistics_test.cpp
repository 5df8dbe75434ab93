#include "master/diagnostics/statistics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "common/render/render.h"
#include "master/diagnostics/leaf_names.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

RenderSettings small_settings() {
  RenderSettings s;
  s.width = 70, s.height = 66, s.spp = 4;
  return s;
}

const auto never = [] { return false; };
const auto unheard = [](std::uint32_t, std::uint32_t) {};

TEST(Statistics, AreWhatTheRenderCountsForAnyNumberOfThreads) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const World world(random_scene(seed));
    RenderSettings s = small_settings();
    if (seed == 5) s.sampler = SamplerKind::adapt1, s.spp = 16;
    RayCounters rendered;
    for (std::uint32_t tile = 0; tile < tile_count({s.width, s.height}); ++tile) {
      const auto images = render_tile(world, s, tile, all_passes, never);
      for (const PassImage& image : *images) rendered += image.counters;
    }
    const auto one = statistics_of(world, s, 1, never, unheard);
    EXPECT_EQ(one->rays, rendered);
    EXPECT_EQ(one, statistics_of(world, s, 3, never, unheard));
  }
}

TEST(Statistics, EachHitIsASolids) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const auto s = statistics_of(World(random_scene(seed)), small_settings(), 2, never, unheard);
    EXPECT_EQ(std::accumulate(s->hits.begin(), s->hits.end(), std::uint64_t{0}),
              s->rays.primary_hits + s->rays.secondary_hits);
  }
}

TEST(Statistics, EachRayToALonelySphereTestsItsBoxAndWhatIsInTheBox) {
  Scene scene;
  scene.nodes = {{Sphere{}, {}, {}, {}, {}, ""}};
  scene.camera = PerspectiveCamera{{0, 0, -5}, {0, 0, 1}, {0, 1, 0}, 60};
  scene.lights = {PointLight{{0, 9, -9}, {1, 1, 1}}};
  const auto s = statistics_of(World(scene), small_settings(), 2, never, unheard);
  const RayCounters& rays = s->rays;
  EXPECT_EQ(s->nearest_tests.boxes, rays.primary + rays.reflected + rays.refracted);
  EXPECT_LT(s->nearest_tests.leaves, s->nearest_tests.boxes);
  EXPECT_EQ(s->nearest_tests.crossings, 2 * rays.primary_hits);  // a reflected ray has left for good
  EXPECT_EQ(s->shadow_tests.boxes, rays.shadow);
  EXPECT_EQ(s->shadow_tests.crossings, 0u);
  EXPECT_GT(rays.shadow, 0u);
  const nlohmann::json json = tests_json(*s);
  EXPECT_EQ(json["nearest"]["boxes_per_ray"], 1);
  EXPECT_EQ(json["shadow"]["rays"], rays.shadow);
}

TEST(Statistics, BadSamplesAreCounted) {
  Scene scene = random_scene(1);
  scene.background = {1e300, 0, 0};  // no float
  const auto s = statistics_of(World(scene), small_settings(), 1, never, unheard);
  EXPECT_GE(s->rays.bad_samples, s->rays.primary - s->rays.primary_hits);
  EXPECT_GT(s->rays.bad_samples, 0u);
}

TEST(Statistics, AStopIsHeard) {
  EXPECT_EQ(statistics_of(
                World(random_scene(1)), small_settings(), 2, [] { return true; }, unheard),
            std::nullopt);
}

TEST(LeafNames, TellThePathTheKindAndTheNumber) {
  Scene scene;
  scene.nodes = {{Operation{CsgOp::unite, 2}, {}, {}, {}, {}, ""},
                 {Operation{CsgOp::subtract, 2}, {}, {}, {}, {}, "clown"},
                 {Sphere{}, {}, {}, {}, {}, ""},
                 {Cube{}, {}, {}, {}, {}, "nose"},
                 {Plane{}, {}, {}, {}, {}, ""}};
  EXPECT_EQ(leaf_names(scene), (std::vector<std::string>{"clown/sphere #0", "clown/nose #1", "plane #2"}));
}

}  // namespace
}  // namespace rayfarm
