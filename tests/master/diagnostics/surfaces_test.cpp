#include "master/diagnostics/surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "common/render/trace.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

/// As many leaves of one kind as asked for.
Scene scene_of(const Solid& solid, std::uint32_t count) {
  Scene scene;
  scene.nodes = {{Operation{CsgOp::unite, count}, {}, {}, {}, {}, {}}};
  for (std::uint32_t i = 0; i < count; ++i) scene.nodes.push_back({solid, {}, {}, {}, {}, {}});
  return scene;
}
/// Of a torus, face and sheet are those of the samples alone.
Scene scene_of_tori(std::uint32_t count) { return scene_of(Torus{}, count); }

Hit hit_of(std::uint32_t leaf, double t, const Vec3d& point, const Vec3d& normal) {
  return {.t = t, .point = point, .normal = normal, .leaf = leaf, .leaf_entering = true};
}

/// On a plane of its own for each leaf, facing the camera.
Hit sample_of(std::uint32_t leaf, double x = 0) {
  const double z = 1 + leaf;
  return hit_of(leaf, z, {x, 0, z}, {0, 0, -1});
}

std::uint64_t sum_of(const PixelSurfaces& surfaces) {
  std::uint64_t sum = surfaces.rest();
  for (const Surface& surface : surfaces.ranked()) sum += surface.weight;
  return sum;
}

TEST(Surfaces, EachSampleBelongsToOneAndTheRanksDescend) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const World world(random_snapped_scene(seed));
    RenderSettings s;
    s.width = 70, s.height = 66;
    Tracer<CountingObserver> tracer(world, s);
    PixelSurfaces surfaces(world, Reduction::majority);
    for (std::uint32_t y = 0; y < s.height; y += 3) {
      surfaces.clear();
      std::uint64_t hits = 0;
      for (std::uint32_t x = 0; x < s.width; ++x)
        if (const auto hit = tracer.first_hit(x + 0.5, y + 0.5)) surfaces.add(*hit, 1), ++hits;
      std::uint64_t last = s.width;
      for (const Surface& surface : surfaces.ranked()) {
        EXPECT_LE(surface.weight, last);
        EXPECT_NEAR(length(surface.normal()), 1, 1e-12);
        last = surface.weight;
      }
      EXPECT_EQ(sum_of(surfaces), hits);
    }
  }
}

TEST(Surfaces, WhatOverAFifthOfTheSamplesShowIsAmongTheRanks) {
  const World world(scene_of_tori(40));
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    // A few heavy surfaces and many light ones, in any order.
    std::vector<std::uint32_t> leaves;
    for (std::uint32_t heavy = 0; heavy < 3; ++heavy) leaves.insert(leaves.end(), 26, heavy);
    for (std::uint32_t light = 3; light < 40; ++light) leaves.push_back(light);  // 115 samples in all
    std::shuffle(leaves.begin(), leaves.end(), random);
    PixelSurfaces surfaces(world, Reduction::majority);
    for (const std::uint32_t leaf : leaves) surfaces.add(sample_of(leaf), 1);
    EXPECT_EQ(sum_of(surfaces), leaves.size());
    const std::vector<Surface> ranked = surfaces.ranked();
    EXPECT_LE(ranked.size(), PixelSurfaces::most);
    for (std::uint32_t heavy = 0; heavy < 3; ++heavy)
      EXPECT_TRUE(std::any_of(ranked.begin(), ranked.end(),
                              [&](const Surface& surface) { return surface.leaf() == heavy; }));
  }
}

TEST(Surfaces, WeightsCountAsSoManySamples) {
  const World world(random_scene(3));
  for (const Reduction reduction :
       {Reduction::majority, Reduction::mean, Reduction::median, Reduction::closest}) {
    PixelSurfaces weighed(world, reduction), repeated(world, reduction);
    for (std::uint32_t i = 0; i < 12; ++i) {
      const Hit sample = sample_of(i % 3, 0.01 * i);
      weighed.add(sample, 1 + i);
      for (std::uint32_t n = 0; n < 1 + i; ++n) repeated.add(sample, 1);
    }
    const Surface *const a = weighed.reduced(80), *const b = repeated.reduced(80);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->leaf(), b->leaf());
    EXPECT_NEAR(a->distance(), b->distance(), 1e-12);
  }
}

TEST(Surfaces, AFaceThatComesIntoViewTwiceIsTwoSurfaces) {
  // A torus seen from the side: its tube edge-on, and its far side from the front.
  const Hit near_1 = hit_of(0, 4.00, {0, 0.25, 4}, {0, 1, 0}),
            near_2 = hit_of(0, 4.01, {0.01, 0.25, 4.01}, {0, 1, 0});
  const Hit far = hit_of(0, 6, {0, 0.26, 6}, {0, 0, -1});
  const World world(scene_of_tori(1));
  PixelSurfaces surfaces(world, Reduction::majority);
  for (const Hit& sample : {far, near_2, near_1}) surfaces.add(sample, 1);
  const std::vector<Surface> ranked = surfaces.ranked();
  ASSERT_EQ(ranked.size(), 2u);
  EXPECT_EQ(ranked[0].weight, 2u);
  EXPECT_EQ(ranked[1].distance(), 6);
}

TEST(Surfaces, WhatIsConvexAndSmoothHasOneSurfaceForEachSide) {
  // A ball within a pixel: its limbs face away from each other.
  const Hit front = hit_of(0, 4, {0, 0, 4}, {0, 0, -1}), limb = hit_of(0, 5, {1, 0, 5}, {1, 0, 0}),
            other_limb = hit_of(0, 5, {-1, 0, 5}, {-1, 0, 0});
  Hit back = hit_of(0, 6, {0, 0, 6}, {0, 0, 1});
  back.leaf_entering = false;  // where another solid has been taken away from it
  for (const Solid& solid : {Solid(Sphere{}), Solid(RoundedCube{0.5})}) {
    const World world(scene_of(solid, 1));
    PixelSurfaces surfaces(world, Reduction::majority);
    for (const Hit& sample : {limb, back, front, other_limb}) surfaces.add(sample, 1);
    const std::vector<Surface> ranked = surfaces.ranked();
    ASSERT_EQ(ranked.size(), 2u);
    EXPECT_EQ(ranked[0].weight, 3u);
    EXPECT_EQ(ranked[1].distance(), 6);
  }
}

TEST(Surfaces, OfEquallyManyTheCloserOneIsFirst) {
  const World world(scene_of_tori(2));
  PixelSurfaces surfaces(world, Reduction::majority);
  surfaces.add(sample_of(1), 1);
  surfaces.add(sample_of(0), 1);
  EXPECT_EQ(surfaces.ranked()[0].leaf(), 0u);
  ASSERT_TRUE(surfaces.reduced(3));  // one that hits nothing does not outweigh it
  EXPECT_EQ(surfaces.reduced(3)->leaf(), 0u);
  EXPECT_FALSE(surfaces.reduced(4));  // two do
}

/// A relief seen from above: z = 10 + 0.3 sin(x / period) over a pixel from 0 to 1.
TEST(Surfaces, TheMeanOfABumpySurfaceIsItsMean) {
  constexpr double period = 0.3, height = 0.03, pi = 3.14159265358979323846;  // 10 % of the period
  const World world(scene_of_tori(1));
  PixelSurfaces surfaces(world, Reduction::majority);
  constexpr int count = 4096;
  double sum = 0, squares = 0, seen = 0;
  for (int i = 0; i < count; ++i) {
    const double x = (i + 0.5) / count, phase = 2 * pi * x / period;
    const double z = 10 + height * std::sin(phase), slope = height * 2 * pi / period * std::cos(phase);
    const Vec3d normal = normalized(Vec3d{slope, 0, -1});
    surfaces.add(hit_of(0, z, {x, 0, z}, normal), 1);
    sum += z, squares += (z - 10) * (z - 10);
  }
  for (const Surface& surface : surfaces.ranked()) seen += static_cast<double>(surface.weight);
  EXPECT_EQ(surfaces.ranked().size(), 1u);  // a relief is one surface
  EXPECT_EQ(seen, count);
  EXPECT_NEAR(surfaces.reduced(count)->distance(), sum / count, 1e-9);
  EXPECT_NEAR(squares / count, height * height / 2, 0.05 * height * height / 2);  // it was bumpy
}

}  // namespace
}  // namespace rayfarm
