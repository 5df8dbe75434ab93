#include <gtest/gtest.h>

#include "common/geometry/leaf.h"
#include "tests/common/geometry/rays.h"
#include "tests/support/solid_definitions.h"

namespace rayfarm {
namespace {

Leaf placed(const Solid& solid, const Affine& world_from_local = {}) {
  return make_leaf(solid, bounded(world_from_local));
}

Crossings along(const Leaf& leaf, const Vec3d& origin, const Vec3d& direction) {
  return crossings(leaf, RayQuery({origin, direction}));
}

TEST(Solids, CrossingsSayWhereARayIsInside) {
  RandomRays random(1);
  for (const Solid& solid : all_solids()) {
    const Leaf leaf = placed(solid);
    for (int i = 0; i < 20'000; ++i) {
      const Vec3d o = random.in_box(2), d = random.direction();
      const Crossings c = along(leaf, o, d);
      bool inside = c.starts_inside;
      double from = 0;
      for (int k = 0; k <= c.count; ++k) {
        const double to = k < c.count ? c.at[static_cast<std::size_t>(k)].t : from + 10;
        ASSERT_LE(from, to);
        if (to - from > 1e-9) {
          ASSERT_EQ(contains(solid, o + d * (0.5 * (from + to))), inside) << solid.index();
        }
        inside = !inside, from = to;
      }
    }
  }
}

TEST(Solids, ARayFromASurfaceMeetsTheSameCrossingsButTheOneItStartsOn) {
  RandomRays random(2);
  for (const Solid& solid : all_solids()) {
    const Leaf leaf = placed(solid);
    int tried = 0;
    while (tried < 5'000) {
      const Ray first = random.towards_box(4, 1);
      const LocalRay<double> local = to_local(leaf, RayQuery(first));
      const Crossings c = crossings(leaf, RayQuery(first));
      if (c.count == 0) continue;
      ++tried;
      const SurfacePoint at = surface_at(leaf, local, c.at[0].t, !c.starts_inside);
      const Vec3d d = random.direction();
      const bool inward = dot(d, at.normal) < 0;
      const LocalRay<double> onward{at.point, d, 0, 0};
      const Crossings known = crossings_from_surface(leaf, onward, inward);
      ASSERT_EQ(known.starts_inside, inward) << solid.index();
      // Seen from a point a little further on, nothing else has happened unless it lies in between.
      if (std::fabs(dot(d, at.normal)) < 1e-3 * length(at.normal)) continue;
      const double ahead = 1e-5;
      const Crossings general = along(leaf, at.point + d * ahead, d);
      if (known.count > 0 && known.at[0].t < 2 * ahead) continue;
      ASSERT_EQ(general.starts_inside, inward) << solid.index();
      ASSERT_EQ(general.count, known.count) << solid.index();
      for (int k = 0; k < known.count; ++k)
        ASSERT_NEAR(general.at[static_cast<std::size_t>(k)].t + ahead,
                    known.at[static_cast<std::size_t>(k)].t, 1e-9);
    }
  }
}

TEST(Solids, AnAxialRayMeetsTheCapsOfACylinder) {
  const Leaf leaf = placed(Cylinder{-0.5, 0.5});
  for (const double angle : {0.0, 1e-300, 1e-100, 1e-17, 1e-9}) {
    const Crossings c = along(leaf, {0.25, 0, -3}, {angle, 0, 1});
    ASSERT_EQ(c.count, 2) << angle;
    EXPECT_DOUBLE_EQ(c.at[0].t, 2.5);
    EXPECT_DOUBLE_EQ(c.at[1].t, 3.5);
  }
  EXPECT_EQ(along(leaf, {1.25, 0, -3}, {0, 0, 1}).count, 0);
}

TEST(Solids, ARayThroughTheApexOfAConeOrAlongAGeneratorStaysEven) {
  RandomRays random(10);
  const Leaf both = placed(Cone{-1, 1});
  for (int i = 0; i < 20'000; ++i) {
    const double off = i % 3 == 0 ? 0 : std::ldexp(1.0, -(i % 60));
    const Vec3d through = random.direction() * off, d = random.direction();
    const double turn = random.uniform(-4, 4), across = std::sqrt(0.5);
    const Vec3d generator{across * std::cos(turn), across * std::sin(turn), across};
    for (const Vec3d& direction : {d, generator, generator + d * off}) {
      const Crossings c = along(both, through - direction * 5.0, direction);
      ASSERT_FALSE(c.starts_inside);
      ASSERT_EQ(c.count % 2, 0);
    }
  }
  // Along the axis it passes from one nappe into the other.
  EXPECT_EQ(along(both, {0.25, 0, -3}, {0, 0, 1}).count, 4);
}

TEST(Solids, ARayParallelToAPlaneIsInsideItForEverOrNever) {
  const Leaf leaf = placed(Plane{});
  EXPECT_TRUE(along(leaf, {0, 0, -1}, {1, 0, 0}).starts_inside);
  EXPECT_EQ(along(leaf, {0, 0, -1}, {1, 0, 0}).count, 0);
  EXPECT_FALSE(along(leaf, {0, 0, 1}, {1, 0, 0}).starts_inside);
}

TEST(Solids, ASphereIsHitOrMissedRightFromAnyDistance) {
  const Leaf leaf = placed(Sphere{});
  RandomRays random(3);
  for (double distance = 1e1; distance <= 1e14; distance *= 10)
    for (int i = 0; i < 1'000; ++i) {
      const double height = 1 + std::ldexp(random.uniform(-1, 1), -(i % 45));
      if (std::fabs(height - 1) < 64 * unit_roundoff) continue;
      const Crossings c = along(leaf, {-distance, height, 0}, {1, 0, 0});
      ASSERT_EQ(c.count, height < 1 ? 2 : 0) << distance << " " << height;
    }
}

TEST(Solids, TheErrorOfACrossingBoundsItsDistanceFromTheExactOne) {
  // The same sphere far from the origin through a chain of transforms and back: exactly the unit sphere.
  RandomRays random(4);
  const Affine there = translation({1000, -2000, 500}) * rotation_deg(1, 37) * scaling({8, 8, 8});
  const Affine back =
      scaling({0.125, 0.125, 0.125}) * rotation_deg(1, -37) * translation({-1000, 2000, -500});
  const Leaf chained = make_leaf(Sphere{}, bounded(back) * bounded(there)), plain = placed(Sphere{});
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Ray r = random.towards_box(5, 1);
    const Crossings a = along(plain, r.origin, r.direction), b = along(chained, r.origin, r.direction);
    if (a.count != 2 || b.count != 2) continue;
    ++hits;
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_LE(std::fabs(a.at[k].t - b.at[k].t), a.at[k].error + b.at[k].error);
      const bool grazing = std::fabs(a.at[0].t - a.at[1].t) <= 0.1;
      ASSERT_TRUE(grazing || b.at[k].error < 1e-9);
    }
  }
  EXPECT_GT(hits, 5'000);
}

TEST(Solids, BoundsHoldAllOfTheSurface) {
  RandomRays random(5);
  const std::vector<Affine> maps{{},
                                 rotation_deg({1, 2, 3}, 50) * scaling({1, 1000, 0.5}),
                                 translation({5, 6, 7}) * rotation_deg(2, 90) * scaling({-1, 2, 3})};
  for (const Solid& solid : all_solids())
    for (const Affine& map : maps) {
      const BoundedAffine placement = bounded(map);
      const Leaf leaf = make_leaf(solid, placement);
      const Box box = bounds_of(solid, placement);
      for (int i = 0; i < 2'000; ++i) {
        const Ray r = random.towards_box(50, 8);
        const RayQuery q(r);
        const Crossings c = crossings(leaf, q);
        const BoxSpan span = span_in(box, q, infinity);
        for (int k = 0; k < c.count; ++k) {
          ASSERT_LE(span.entry, c.at[static_cast<std::size_t>(k)].hi());
          ASSERT_GE(span.exit, c.at[static_cast<std::size_t>(k)].lo());
        }
      }
    }
}

TEST(Solids, NormalsPointOutwardThroughMirroringAndShear) {
  RandomRays random(6);
  Affine shear;
  shear.linear[1][0] = 0.7;
  for (const Solid& solid : all_solids())
    for (const Affine& map : {scaling({-1, 1, 1}), shear, scaling({1, -2, 3}) * rotation_deg(0, 20)}) {
      const Leaf leaf = placed(solid, map);
      for (int i = 0; i < 500; ++i) {
        const Ray r = random.towards_box(6, 1);
        const LocalRay<double> local = to_local(leaf, RayQuery(r));
        const Crossings c = crossings(leaf, RayQuery(r));
        if (c.count == 0) continue;
        const bool entering = !c.starts_inside;
        const Vec3d n = normal_to_world(leaf, surface_at(leaf, local, c.at[0].t, entering).normal);
        ASSERT_NEAR(length(n), 1, 1e-12);
        const bool grazing = std::fabs(dot(n, r.direction)) <= 1e-6;
        ASSERT_TRUE(grazing || (dot(n, r.direction) < 0) == entering) << solid.index();
      }
    }
}

}  // namespace
}  // namespace rayfarm
