#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "common/geometry/bvh.h"
#include "tests/common/geometry/rays.h"

namespace rayfarm {
namespace {

std::vector<Box> random_boxes(RandomRays& random, int count) {
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) {
    const Vec3d low = random.in_box(5), size = random.in_box(0.5);
    boxes.push_back({low, low + Vec3d{std::fabs(size.x), std::fabs(size.y), std::fabs(size.z)}});
  }
  return boxes;
}

TEST(Bvh, VisitsEveryBoxThatTheRayMeets) {
  RandomRays random(10);
  for (const int count : {0, 1, 2, 3, 100, 3000}) {
    const std::vector<Box> boxes = random_boxes(random, count);
    const Bvh bvh(boxes);
    for (int i = 0; i < 500; ++i) {
      Ray r;
      r.origin = random.in_box(8), r.direction = random.direction();
      if (i % 5 == 0) r.direction = {0, i % 2 ? 1.0 : -1.0, 0};
      const RayQuery q(r);
      std::set<std::uint32_t> visited;
      bvh.visit(q, infinity, [&](std::uint32_t place) { return visited.insert(bvh.order()[place]).second; });
      for (std::uint32_t n = 0; n < boxes.size(); ++n) {
        const BoxSpan span = span_in(boxes[n], q, infinity);
        ASSERT_TRUE(span.entry > span.exit || visited.contains(n));
      }
    }
  }
}

TEST(Bvh, WithoutBoxesIsMetByNoRayAlsoNoneOfNan) {
  const Bvh none(std::span<const Box>{});
  for (const double x : {0.0, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    Ray r;
    r.origin = {x, x, x}, r.direction = {x, x, x};
    int visited = 0;
    none.visit(RayQuery(r), infinity, [&](std::uint32_t) { return ++visited > 0; });
    EXPECT_EQ(visited, 0);
  }
}

TEST(Bvh, HoldsManyEqualBoxes) {
  const std::vector<Box> boxes(1000, Box{{0, 0, 0}, {1, 1, 1}});
  const Bvh bvh(boxes);
  Ray r;
  r.origin = {0.5, 0.5, -3}, r.direction = {0, 0, 1};
  int visited = 0;
  bvh.visit(RayQuery(r), infinity, [&](std::uint32_t) { return ++visited > 0; });
  EXPECT_EQ(visited, 1000);
}

}  // namespace
}  // namespace rayfarm
