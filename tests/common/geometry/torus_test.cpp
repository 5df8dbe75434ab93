#include <gtest/gtest.h>

#include "common/geometry/torus.h"
#include "tests/common/geometry/rays.h"

namespace rayfarm {
namespace {

LocalRay<double> local(const Ray& r) { return {r.origin, r.direction, 0, unit_roundoff}; }

TEST(Torus, ARayFromOutsideAlwaysCrossesAnEvenNumberOfTimes) {
  RandomRays random(7);
  for (const Torus torus : {Torus{2, 1}, Torus{1, 1.5}, Torus{0.2, 0.01}, Torus{1, 1}, Torus{100, 0.1}})
    for (const double distance : {1.5, 10.0, 1e4, 1e6})
      for (int i = 0; i < 20'000; ++i) {
        const double size = torus.R + torus.r;
        const Crossings c = crossings_of(torus, local(random.towards_box(distance * size, size)));
        ASSERT_EQ(c.count % 2, 0);
        ASSERT_FALSE(c.starts_inside);
        for (int k = 1; k < c.count; ++k)
          ASSERT_LE(c.at[static_cast<std::size_t>(k - 1)].t, c.at[static_cast<std::size_t>(k)].t);
      }
}

TEST(Torus, CrossingsLieOnTheSurface) {
  RandomRays random(8);
  for (const Torus torus : {Torus{2, 1}, Torus{1, 1.5}, Torus{0.2, 0.01}}) {
    const double size = torus.R + torus.r;
    for (int i = 0; i < 20'000; ++i) {
      const Ray r = random.towards_box(3 * size, size);
      const Crossings c = crossings_of(torus, local(r));
      for (int k = 0; k < c.count; ++k) {
        const double t = c.at[static_cast<std::size_t>(k)].t;
        const Vec3d p = r.origin + r.direction * t, on = surface_of(torus, local(r), t, true).point;
        ASSERT_LT(length(p - on), 8 * c.at[static_cast<std::size_t>(k)].error + 64 * unit_roundoff * size);
      }
    }
  }
}

TEST(Torus, ARayThroughTheTubesTopTangentPlaneStaysEven) {
  // The plane z = r touches the torus along a circle: double roots all around.
  const Torus torus{20, 1};
  RandomRays random(9);
  for (int k = 2; k <= 15; ++k)
    for (int i = 0; i < 2'000; ++i) {
      const double z = 1 - std::pow(10.0, -k);
      const Vec3d target{random.uniform(-20, 20), random.uniform(-20, 20), z};
      Ray r;
      r.origin = {random.uniform(-30, -25), random.uniform(-30, 30), z};
      r.direction = normalized(target - r.origin);
      ASSERT_EQ(crossings_of(torus, local(r)).count % 2, 0);
    }
}

TEST(Torus, ARayAlongTheAxisOfASpindleFindsAppleAndLemon) {
  const Torus spindle{0.5, 1};
  const double tip = std::sqrt(1 - 0.25);
  Ray r;
  r.origin = {0.01, 0, -5}, r.direction = {0, 0, 1};
  const Crossings c = crossings_of(spindle, local(r));
  ASSERT_EQ(c.count, 4);
  EXPECT_NEAR(c.at[0].t, 5 - tip, 0.01);
  EXPECT_NEAR(c.at[1].t, 5 - tip, 0.01);
  EXPECT_NEAR(c.at[2].t, 5 + tip, 0.01);
  EXPECT_NEAR(c.at[3].t, 5 + tip, 0.01);
}

}  // namespace
}  // namespace rayfarm
