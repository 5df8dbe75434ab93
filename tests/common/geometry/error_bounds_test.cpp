// The error that a crossing states, against 113 bits on the same rounded inputs.
#include <gtest/gtest.h>

#include <cmath>

#include "common/geometry/leaf.h"
#include "tests/common/geometry/rays.h"
#include "tests/stability/quad_solids.h"
#include "tests/support/solid_definitions.h"

namespace rayfarm {
namespace {

using stability::Quad;

/// Maps that make the bounds work: none, a move and a turn, stretch, mirror and shear after that.
Affine random_map(int kind, RandomRays& random) {
  if (kind == 0) return {};
  const Vec3d by = random.in_box(3);
  const glm::dvec3 axis{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)};
  const Affine placed = translation({by.x, by.y, by.z}) * rotation_deg(axis, random.uniform(-180, 180));
  if (kind == 1) return placed;
  const auto factor = [&] { return std::pow(10.0, random.uniform(-1, 1)); };
  Affine shear;
  shear.linear[1][0] = random.uniform(-1, 1);
  return placed * scaling({factor(), factor(), -factor()}) * shear;
}

Vec3d direction_by(const Affine& m, const Vec3d& d) { return vec(m.linear * glm::dvec3(d.x, d.y, d.z)); }
Vec3d point_by(const Affine& m, const Vec3d& p) { return vec(point(m, {p.x, p.y, p.z})); }

/// From 3 to 10^9 away; some graze the unit sphere, some run along a local axis but for a tiny angle.
Ray hard_ray(int number, const Affine& map, RandomRays& random) {
  const double distance = std::pow(10.0, random.uniform(0.5, 9));
  Vec3d target = random.in_box(1.1), away = random.direction();
  if (number % 4 == 1) {
    const double off = std::pow(10.0, random.uniform(-16, -3));
    target = normalized(cross(away, random.direction())) * (1 + (number % 8 == 1 ? off : -off));
  }
  if (number % 4 == 3)
    for (int i = 0; i < 3; ++i)
      away[i] = i == number / 4 % 3 ? 1 : std::pow(10.0, random.uniform(-20, 0)) * random.uniform(-1, 1);
  Ray ray;
  ray.direction = direction_by(map, -away);
  ray.origin = point_by(map, target) - ray.direction * distance;
  return ray;
}

/// Without pairs that cancel: what is left of a line that touches.
std::vector<Crossing> without_pairs(const Crossings& c, std::size_t wanted) {
  std::vector<Crossing> rest(c.at.begin(), c.at.begin() + c.count);
  for (std::size_t k = 0; k + 1 < rest.size() && rest.size() > wanted;)
    if (rest[k].hi() >= rest[k + 1].lo())
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k),
                 rest.begin() + static_cast<std::ptrdiff_t>(k) + 2);
    else
      ++k;
  return rest;
}

TEST(ErrorBounds, NoCrossingIsFartherFromTheExactOneThanItStates) {
  constexpr int rays = 4'000;
  RandomRays random(20);
  for (const Solid& solid : all_solids())
    for (int kind = 0; kind < 3; ++kind) {
      int compared = 0, others = 0;
      for (int i = 0; i < rays; ++i) {
        const Affine map = random_map(kind, random);
        const Leaf leaf = make_leaf(solid, BoundedAffine{map});
        const Ray ray = hard_ray(i, map, random);
        const auto truth =
            stability::quad_spans(solid, moved(inverse(stability::quad(map)), stability::quad(ray)));
        std::vector<Quad> ahead;
        for (const Quad t : truth.at)
          if (t > 0) ahead.push_back(t);
        const std::vector<Crossing> ours = without_pairs(crossings(leaf, RayQuery(ray)), ahead.size());
        if (ours.size() != ahead.size()) {
          ++others;
          continue;
        }
        compared += static_cast<int>(ours.size());
        for (std::size_t k = 0; k < ours.size(); ++k)
          ASSERT_LE(static_cast<double>(fabsq(ahead[k] - Quad(ours[k].t))), ours[k].error)
              << kind_of(solid) << ", map " << kind << ", ray " << i;
      }
      EXPECT_GT(compared, rays / 20) << kind_of(solid) << ", map " << kind;
      // Lines along a face, within the uncertainty of the map.
      EXPECT_LE(others, kind == 0 ? rays / 500 : rays / 30) << kind_of(solid) << ", map " << kind;
    }
}

TEST(ErrorBounds, AGlanceThatIsSureAgreesToTheBitWithACloseLook) {
  constexpr int rays = 20'000;
  RandomRays random(21);
  for (const Solid& solid : all_solids()) {
    int sure = 0;
    for (int i = 0; i < rays; ++i) {
      const Affine map = random_map(i % 3, random);
      const Leaf leaf = make_leaf(solid, bounded(map));
      Ray ray = hard_ray(i / 3, map, random);
      if (i % 2) {
        const Ray near = random.towards_box(5, 1.5);  // and some that start inside
        ray.direction = direction_by(map, near.direction);
        ray.origin = point_by(map, near.origin * random.uniform(0, 1));
        ray.origin_error = i % 4 == 1 ? 0 : 0x1p-50 * max_abs(ray.origin);
      }
      const Glance g = glance(leaf, RayQuery(ray));
      if (g.verdict == Glance::Verdict::unsure) continue;
      ++sure;
      const Crossings close = crossings(leaf, RayQuery(ray));
      const bool passes = g.verdict == Glance::Verdict::passes;
      ASSERT_EQ(close.starts_inside, passes && g.enter < 0) << kind_of(solid) << ", ray " << i;
      std::vector<double> ends;
      if (passes && g.enter > 0) ends.push_back(g.enter);
      if (passes && g.leave < infinity) ends.push_back(g.leave);
      const std::vector<Crossing> found = without_pairs(close, ends.size());
      ASSERT_EQ(found.size(), ends.size()) << kind_of(solid) << ", ray " << i;
      for (std::size_t k = 0; k < ends.size(); ++k) {
        ASSERT_EQ(found[k].t, ends[k]) << kind_of(solid) << ", ray " << i;
        ASSERT_LE(found[k].hi(), ends[k] + g.blur) << kind_of(solid) << ", ray " << i;
      }
    }
    const bool has_glance = std::holds_alternative<Sphere>(solid) || std::holds_alternative<Plane>(solid) ||
                            std::holds_alternative<Cylinder>(solid) || std::holds_alternative<Cube>(solid);
    EXPECT_GT(sure, has_glance ? rays * 2 / 5 : -1) << kind_of(solid);
  }
}

}  // namespace
}  // namespace rayfarm
