// Surfaces of many parts: closed ones are entered as often as they are left, whatever ray comes.
#include "common/geometry/facets.h"

#include <gtest/gtest.h>

#include "tests/common/geometry/rays.h"
#include "tests/support/surfaces.h"

namespace rayfarm {
namespace {

LocalRay<double> line(const Vec3d& from, const Vec3d& to) { return {from, to - from, 0, 0, {}}; }

std::vector<FacetCrossing> path_of(const Facets& facets, const LocalRay<double>& ray) {
  FacetPath path;
  find_path(facets, ray, {}, path);
  return path.crossings;
}

/// Where the line crosses a triangle's plane, from the rounded numbers without further rounding to speak of.
double plane_crossing(const Vec3d& a, const Vec3d& b, const Vec3d& c, const LocalRay<double>& ray) {
  using Wide = Vec3<__float128>;
  const auto wide = [](const Vec3d& v) { return Wide{v.x, v.y, v.z}; };
  const Wide n = cross(wide(b) - wide(a), wide(c) - wide(a));
  return static_cast<double>(dot(n, wide(a) - wide(ray.origin)) / dot(n, wide(ray.direction)));
}

TEST(MeshFacets, NoLineLeaksThroughAnEdgeOrACorner) {
  RandomRays random(7);
  const TriangleMesh ball = ball_mesh(6, 9);
  ASSERT_TRUE(is_closed(ball));
  const auto facets = make_facets(ball);
  for (int i = 0; i < 50'000; ++i) {
    const IndexTriple& t =
        ball.triangles[static_cast<std::size_t>(random.uniform(0, double(ball.triangles.size())))];
    const Vec3d &a = ball.points[t[0]], &b = ball.points[t[1]];
    const double along = i % 2 ? 0 : random.uniform(0, 1);
    const LocalRay<double> ray = line(random.direction() * 5.0, a + (b - a) * along);
    FacetPath path;
    find_path(*facets, ray, {}, path);
    EXPECT_FALSE(path.starts_inside);
    EXPECT_EQ(path.crossings.size() % 2, 0u);
  }
}

TEST(MeshFacets, EveryLineToAPointInsideMeetsTheFront) {
  RandomRays random(8);
  const TriangleMesh ball = ball_mesh(8, 12);
  const auto facets = make_facets(ball);
  for (int i = 0; i < 50'000; ++i) {
    const IndexTriple& t =
        ball.triangles[static_cast<std::size_t>(random.uniform(0, double(ball.triangles.size())))];
    const Vec3d inside = random.in_box(0.3), edge = (ball.points[t[0]] + ball.points[t[1]]) * 0.5;
    const Vec3d target = i % 2 ? inside : edge, from = inside + (target - inside) * 10.0;
    if (target == inside) continue;
    const auto found = nearest_crossing(*facets, line(from, inside), {}, infinity);
    ASSERT_TRUE(found.crossing) << i;
    EXPECT_TRUE(found.crossing->entering);
  }
}

TEST(MeshFacets, TheErrorBoundHoldsForNeedlesSeenFromFarAway) {
  RandomRays random(9);
  for (int i = 0; i < 20'000; ++i) {
    const double thin = std::pow(10.0, random.uniform(-8, 0)), away = std::pow(10.0, random.uniform(0, 6));
    TriangleMesh needle;
    needle.points = {random.in_box(1), random.in_box(1)};
    needle.points.push_back(needle.points[0] + random.direction() * thin);
    needle.triangles = {{0, 1, 2}};
    const auto facets = make_facets(needle);
    const Vec3d &a = needle.points[0], &b = needle.points[1], &c = needle.points[2];
    const Vec3d target = (a + b + c) * (1.0 / 3);
    const LocalRay<double> ray = line(target + random.direction() * away, target);
    for (const FacetCrossing& found : crossings_of_line(*facets, ray)) {
      EXPECT_LE(std::fabs(found.t - plane_crossing(a, b, c, ray)), found.error) << thin << " " << away;
    }
  }
}

TEST(MeshFacets, ARayLeavesItsTriangleByIdentity) {
  RandomRays random(10);
  const TriangleMesh ball = ball_mesh(10, 15);
  const auto facets = make_facets(ball);
  for (int i = 0; i < 20'000; ++i) {
    const LocalRay<double> to = line(random.direction() * 5.0, random.in_box(0.4));
    const auto hit = nearest_crossing(*facets, to, {}, infinity);
    ASSERT_TRUE(hit.crossing);
    const FacetPoint at = point_at(*facets, to, *hit.crossing, false);
    Vec3d away = random.direction();
    if (dot(away, at.surface.normal) < 0) away = -away;
    for (const bool inward : {false, true}) {
      LocalRay<double> from{at.surface.point, inward ? -away : away, at.error + 1e-15, 0, {}};
      FacetPath path;
      find_path(*facets, from, {hit.crossing->part, inward}, path);
      EXPECT_EQ(path.starts_inside, inward);
      EXPECT_EQ(path.crossings.size(), inward ? 1u : 0u);  // the ball is convex
    }
  }
}

TEST(MeshFacets, OverlappingPartsOfAMeshAreOneSolid) {
  TriangleMesh two = ball_mesh(6, 9);
  const std::size_t points = two.points.size(), triangles = two.triangles.size();
  for (std::size_t i = 0; i < points; ++i) two.points.push_back(two.points[i] + Vec3d{0.7, 0, 0});
  for (std::size_t i = 0; i < triangles; ++i) {
    IndexTriple t = two.triangles[i];
    for (std::uint32_t& corner : t) corner += static_cast<std::uint32_t>(points);
    two.triangles.push_back(t);
  }
  const auto facets = make_facets(two);
  const std::vector<FacetCrossing> found = path_of(*facets, line({-5, 0.01, 0.02}, {5, 0.01, 0.02}));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_TRUE(found[0].entering);
  EXPECT_FALSE(found[1].entering);
}

// Bezier surfaces. ------------------------------------------------------------------------------------------

TEST(BezierFacets, PointsLieOnTheSurfaceAndOnTheLine) {
  RandomRays random(11);
  const BezierGrid hill = hill_grid();
  const auto facets = make_facets(hill);
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const LocalRay<double> ray = line(random.direction() * 6.0, random.in_box(1.5));
    for (const FacetCrossing& c : crossings_of_line(*facets, ray)) {
      const FacetPoint at = point_at(*facets, ray, c, true);
      const Vec3d surface = bezier_point(hill, at.texture.u, at.texture.v);
      EXPECT_LE(max_abs(surface - at.surface.point), 1e-14);
      EXPECT_LE(max_abs(ray.origin + ray.direction * c.t - at.surface.point), 1e-12);
      EXPECT_EQ(c.entering, dot(at.surface.normal, ray.direction) < 0);
      ++hits;
    }
  }
  EXPECT_GT(hits, 5000);
}

TEST(BezierFacets, NoLineSeesThroughAClosedSurface) {
  RandomRays random(12);
  const BezierGrid ball = ball_grid();
  ASSERT_TRUE(is_closed(ball));
  const auto facets = make_facets(ball);
  for (int i = 0; i < 20'000; ++i) {
    const Vec3d inside = random.in_box(0.3);
    // Every other one through a border of two patches.
    const double u = random.uniform(0, 4), v = random.uniform(0, 2);
    const Vec3d target = bezier_point(ball, i % 2 ? std::floor(u) : u, i % 4 < 2 ? v : 1);
    const auto found =
        nearest_crossing(*facets, line(inside + (target - inside) * 4.0, inside), {}, infinity);
    ASSERT_TRUE(found.crossing) << i;
    FacetPath path;
    find_path(*facets, line(inside, target), {}, path);
    EXPECT_TRUE(path.starts_inside);
    ASSERT_EQ(path.crossings.size(), 1u) << i;
    EXPECT_NEAR(path.crossings[0].t, 1, 1e-9);
  }
}

TEST(BezierFacets, ASurfaceTurnedInsideOutIsTheSameSolid) {
  BezierGrid ball = ball_grid();
  for (std::size_t row = 0; row < ball.height(); ++row)
    std::reverse(ball.points.begin() + static_cast<std::ptrdiff_t>(row * ball.width()),
                 ball.points.begin() + static_cast<std::ptrdiff_t>((row + 1) * ball.width()));
  const auto facets = make_facets(ball);
  const LocalRay<double> ray = line({-5, 0.1, 0.2}, {0, 0, 0.1});
  const auto found = nearest_crossing(*facets, ray, {}, infinity);
  ASSERT_TRUE(found.crossing);
  EXPECT_TRUE(found.crossing->entering);
  EXPECT_LT(dot(point_at(*facets, ray, *found.crossing, true).surface.normal, ray.direction), 0);
}

TEST(BezierFacets, AnOpenSurfaceIsASheet) { EXPECT_FALSE(is_closed(*make_facets(hill_grid()))); }

}  // namespace
}  // namespace rayfarm
