// CSG by its law: inside(a op b) == op(inside a, inside b), along random rays of random trees; and what must
// vanish.
#include <gtest/gtest.h>

#include "common/render/hit.h"
#include "common/render/world_parts.h"
#include "tests/common/geometry/rays.h"
#include "tests/support/random_scene.h"
#include "tests/support/solid_definitions.h"

namespace rayfarm {
namespace {

Node leaf(const Solid& solid, const Affine& map = {}) { return {solid, map, {}, {}, {}, {}}; }
Node inner(CsgOp op, std::uint32_t children) { return {Operation{op, children}, {}, {}, {}, {}, {}}; }

/// Local coordinates of the point in each leaf, and whether it is inside.
class Membership {
 public:
  explicit Membership(const World::Parts& world) : world_(world) {}

  bool of(const WorldObject& object, const Vec3d& p) const { return of(world_.items_of(object), 0, p); }

 private:
  bool of(std::span<const CsgItem> items, std::uint32_t i, const Vec3d& p) const {
    const CsgItem& item = items[i];
    if (item.leaf != no_leaf) return in_leaf(world_.leaves[item.leaf], p);
    bool value = false;
    std::uint32_t child = i + 1;
    for (std::uint32_t k = 0; k < item.children; ++k, child = items[child].next) {
      const bool c = of(items, child, p);
      if (k == 0)
        value = c;
      else if (item.op == CsgOp::unite)
        value = value || c;
      else if (item.op == CsgOp::intersect)
        value = value && c;
      else if (item.op == CsgOp::subtract)
        value = value && !c;
      else
        value = value != c;
    }
    return value;
  }

  static bool in_leaf(const Leaf& leaf, const Vec3d& world) {
    // Any ray from the point knows the side at its origin.
    Ray r;
    r.origin = world, r.direction = {0.5, 0.6, 0.7};
    return crossings(leaf, RayQuery(r)).starts_inside;
  }

  const World::Parts& world_;
};

TEST(Csg, ARayIsInsideAnObjectWhereItsPointsAre) {
  RandomRays random(11);
  int checked = 0;
  for (std::uint64_t seed = 1000; seed < 1100; ++seed) {
    const World world(random_scene(seed));
    const Membership membership(world.parts());
    CsgWorkspace ws;
    for (const WorldObject& object : world.parts().objects) {
      const auto items = world.parts().items_of(object);
      for (int i = 0; i < 50; ++i) {
        const Ray r = random.towards_box(8, 2);
        bool inside = gather(items, world.parts().leaves, RayQuery(r), infinity, ws);
        double from = 0;
        Boundary b;
        for (std::size_t next = 0;;) {
          const bool more = next_boundary(items, ws, next, b);
          const double to = more ? b.t : from + 1;
          if (to - from > 1e-6) {
            ASSERT_EQ(membership.of(object, r.origin + r.direction * (0.5 * (from + to))), inside) << seed;
            ++checked;
          }
          if (!more) break;
          ASSERT_EQ(b.entering, !inside);
          inside = b.entering, from = to;
        }
      }
    }
  }
  EXPECT_GT(checked, 5'000);
}

/// What an object's first boundary is at a glance, and closely.
class TwoLooks {
 public:
  explicit TwoLooks(const World& world) : world_(world.parts()) {}

  void expect_same(const WorldObject& object, const RayQuery& q) {
    const auto items = world_.items_of(object);
    Boundary first;
    std::size_t next = 0;
    const ObjectStart start = start_at_a_glance(items, world_.leaves, q, infinity, glancing_);
    ASSERT_EQ(start.inside, gather(items, world_.leaves, q, infinity, close_));
    ASSERT_EQ(start.has_boundary, next_boundary(items, close_, next, first));
    if (!start.has_boundary) return;
    ASSERT_EQ(start.first.t, first.t);
    ASSERT_EQ(start.first.leaf, first.leaf);
    ASSERT_EQ(start.first.entering, first.entering);
    ASSERT_GE(start.first.t + start.first.error, first.t + first.error);
  }

 private:
  const World::Parts& world_;
  CsgWorkspace close_, glancing_;
};

TEST(Csg, AGlanceFindsTheSameFirstBoundaryAsACloseLook) {
  RandomRays random(13);
  for (Scene (*make)(std::uint64_t) : {random_scene, random_snapped_scene})
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      const World world(make(seed));
      TwoLooks looks(world);
      for (const WorldObject& object : world.parts().objects)
        for (int i = 0; i < 50; ++i) {
          looks.expect_same(object, RayQuery(random.towards_box(8, 2)));
          if (HasFatalFailure()) FAIL() << "scene " << seed;
        }
    }
}

/// What lies in some of the solids, but not in an odd number of them.
Scene doubled(const std::vector<Node>& solids) {
  Scene scene;
  const auto count = static_cast<std::uint32_t>(solids.size());
  scene.nodes = {inner(CsgOp::subtract, 2)};
  for (const CsgOp op : {CsgOp::unite, CsgOp::exclusive_or}) {
    scene.nodes.push_back(inner(op, count));
    scene.nodes.insert(scene.nodes.end(), solids.begin(), solids.end());
  }
  return scene;
}

// Also rays that start on a surface, in a plane of several caps.
TEST(Csg, ASolidThatStandsInAnObjectTwiceIsSeenTheSameAtAGlance) {
  RandomRays random(14);
  for (const Solid& solid : all_solids())
    for (int scene_number = 0; scene_number < 10; ++scene_number) {
      const Affine turn = rotation_deg(glm::dvec3{1, 0.3, 0.2}, random.uniform(-180, 180));
      std::vector<Node> row;
      for (int i = 0; i < 4; ++i) row.push_back(leaf(solid, turn * translation({0.6 * i - 1, 0, 0})));
      const World world(doubled(row));
      TwoLooks looks(world);
      WorldWorkspace ws;
      const WorldObject& object = world.parts().objects.at(0);
      for (int i = 0; i < 300; ++i) {
        const RayQuery q(random.towards_box(8, 2));
        looks.expect_same(object, q);
        const std::optional<Boundary> met = first_boundary(world.parts(), q, ws);
        if (!met) continue;
        const Hit hit = hit_at(world.parts(), q, *met);
        const Vec3d direction = random.direction();
        looks.expect_same(object, RayQuery(ray_from(hit, direction, dot(direction, hit.normal) > 0)));
        if (HasFatalFailure()) FAIL() << kind_of(solid);
      }
    }
}

/// Two chains of transforms that are the same in exact arithmetic, the first stretched by up to 10^decades.
std::pair<Affine, Affine> twin_chains(RandomRays& random, double decades = 0) {
  const double a = random.uniform(-180, 180), b = random.uniform(-180, 180);
  const auto factor = [&] { return std::pow(10.0, random.uniform(-decades, decades)); };
  const Affine stretch = scaling({factor(), factor(), factor()});
  const glm::dvec3 axis{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)};
  const glm::dvec3 move{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
  const Affine one = translation(move) * rotation_deg(axis, a + b) * stretch;
  const Affine two = translation(move) * rotation_deg(axis, a) * rotation_deg(axis, b) * stretch;
  return {one, two};
}

int boundaries(const World& world, const Ray& r, CsgWorkspace& ws) {
  int count = 0;
  for (const WorldObject& object : world.parts().objects) {
    const auto items = world.parts().items_of(object);
    gather(items, world.parts().leaves, RayQuery(r), infinity, ws);
    Boundary b;
    for (std::size_t next = 0; next_boundary(items, ws, next, b);) ++count;
  }
  return count;
}

TEST(Csg, ASolidMinusItselfIsNothingWhateverItsTransforms) {
  RandomRays random(12);
  CsgWorkspace ws;
  for (const CsgOp op : {CsgOp::exclusive_or, CsgOp::subtract})
    for (const Solid& solid : all_solids())
      for (int scene_number = 0; scene_number < 20; ++scene_number) {
        const auto [one, two] = twin_chains(random);
        Scene scene;
        scene.nodes = {inner(op, 2), leaf(solid, one), leaf(solid, two)};
        const World world(scene);
        for (int i = 0; i < 2'000; ++i) {
          Ray r = random.towards_box(10, 3);
          if (i % 2) {  // aimed at the solid
            const glm::dvec3 c = one.offset;
            r.direction = normalized(Vec3d{c.x, c.y, c.z} + random.in_box(1) - r.origin);
          }
          ASSERT_EQ(boundaries(world, r, ws), 0)
              << "solid " << solid.index() << " op " << static_cast<int>(op);
        }
      }
}

// So they need no common name to be known as one.
TEST(Csg, SolidsThatAreTheSameInAllBitsCrossInTheSameBits) {
  RandomRays random(17);
  CsgWorkspace ws;
  for (const Solid& solid : all_solids()) {
    const Affine map = twin_chains(random, 2).first;
    const auto world_of = [&](CsgOp op) {
      Scene scene;
      scene.nodes = {inner(CsgOp::subtract, 2), inner(op, 2), leaf(solid, map), leaf(solid, map),
                     leaf(Sphere{})};
      scene.nodes[4].parent_from_node.offset = {1e9, 0, 0};
      return World(scene);
    };
    const World both = world_of(CsgOp::intersect), none = world_of(CsgOp::exclusive_or);
    const Leaf alone = make_leaf(solid, bounded(map));
    for (int i = 0; i < 2'000; ++i) {
      Ray r = random.towards_box(10, 3);
      r.origin = r.origin + vec(map.offset);
      ASSERT_EQ(boundaries(none, r, ws), 0) << kind_of(solid);
      const Crossings c = crossings(alone, RayQuery(r));
      if (boundaries(both, r, ws) == 0) continue;
      const auto items = both.parts().items_of(both.parts().objects[0]);
      gather(items, both.parts().leaves, RayQuery(r), infinity, ws);
      Boundary b;
      for (std::size_t next = 0; next_boundary(items, ws, next, b);)
        ASSERT_TRUE(std::any_of(c.at.begin(), c.at.begin() + c.count, [&](const Crossing& at) {
          return at.t == b.t && at.error == b.error;
        })) << kind_of(solid);
    }
  }
}

TEST(Csg, ASolidMinusItselfIsNothingFromItsInsideAlso) {
  RandomRays random(16);
  CsgWorkspace ws;
  for (const double decades : {0.0, 1.0, 2.0, 3.0})
    for (const Solid& solid : all_solids())
      for (int scene_number = 0; scene_number < 10; ++scene_number) {
        const auto [one, two] = twin_chains(random, decades);
        Scene scene;
        // One of them through a chain of nodes: its error bound is another one.
        scene.nodes = {inner(CsgOp::exclusive_or, 2), leaf(solid, one), inner(CsgOp::unite, 1), leaf(solid)};
        scene.nodes[2].parent_from_node = two;
        const World world(scene);
        for (int i = 0; i < 1'000; ++i) {
          Ray r;
          const glm::dvec3 start = point(one, glm::dvec3(i % 2 ? 0 : random.uniform(-0.1, 0.1)));
          r.origin = {start.x, start.y, start.z}, r.direction = random.direction();
          ASSERT_EQ(boundaries(world, r, ws), 0) << "solid " << solid.index() << " decades " << decades;
        }
      }
}

/// Whether a ray through x = y = 0 along z meets the two solids combined.
bool meets(CsgOp op, const Node& a, const Node& b) {
  Scene scene;
  scene.nodes = {inner(op, 2), a, b};
  const World world(scene);
  WorldWorkspace ws;
  Ray r;
  r.origin = {0, 0, -5}, r.direction = {0, 0, 1};
  return first_boundary(world.parts(), RayQuery(r), ws).has_value();
}

TEST(Csg, ARayInACommonFaceIsInsideExactlyOneOfTwoNeighbours) {
  // Left and right of x = 0, above and below y = 0: however the neighbour was turned there.
  const Affine low = translation({0, -0.5, 0});
  for (const Affine& turn : {translation({-1, 0, 0}), rotation_deg(1, 180) * translation({0, 0, -1}),
                             scaling({-1, 1, 1}), rotation_deg(2, 180) * translation({0, -1, 0})}) {
    const Node here = leaf(Cube{}, low), there = leaf(Cube{}, low * turn);
    EXPECT_TRUE(meets(CsgOp::unite, here, there));
    EXPECT_FALSE(meets(CsgOp::intersect, here, there));
    EXPECT_TRUE(meets(CsgOp::exclusive_or, here, there));
  }
  const Node ball = leaf(Sphere{});
  EXPECT_TRUE(meets(CsgOp::intersect, ball, leaf(Plane{}, rotation_deg(0, 90))) !=
              meets(CsgOp::intersect, ball, leaf(Plane{}, rotation_deg(0, -90))));
}

TEST(Csg, AFarPlaneIsThereOrNotAtEveryScaleAlike) {
  // Rays within rounding of the horizon: their error bounds must scale with the scene.
  RandomRays random(17);
  WorldWorkspace ws;
  Scene scene;
  scene.nodes = {inner(CsgOp::unite, 1), leaf(Plane{}, translation({0, -1, 0}) * rotation_deg(0, -90))};
  const World here(scene);
  for (const double scale : {0x1p-20, 0.5, 2.0, 0x1p20}) {
    scene.nodes[0].parent_from_node = scaling({scale, scale, scale});
    const World there(scene);
    for (int i = 0; i < 2'000; ++i) {
      Ray r;
      r.origin = random.in_box(3);
      r.direction = normalized(Vec3d{random.uniform(-1, 1), random.uniform(-2e-14, 2e-14), 1});
      const auto a = first_boundary(here.parts(), RayQuery(r), ws);
      r.origin = r.origin * scale;
      const auto b = first_boundary(there.parts(), RayQuery(r), ws);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (a) {
        ASSERT_EQ(a->t * scale, b->t);
        ASSERT_EQ(a->error * scale, b->error);
      }
    }
  }
}

TEST(Csg, ASharedFaceLeavesNoSkin) {
  // A box with its upper half taken away: the cut goes exactly through faces of the rest.
  RandomRays random(13);
  CsgWorkspace ws;
  for (int scene_number = 0; scene_number < 50; ++scene_number) {
    const Affine turn = rotation_deg({1, 1, 0.3}, random.uniform(0, 360));
    Scene scene;
    scene.nodes = {inner(CsgOp::subtract, 2), leaf(Cube{}, turn),
                   leaf(Cube{}, turn * translation({0, 0.5, 0}) * scaling({1, 0.5, 1}))};
    scene.nodes[0].parent_from_node = translation({-0.5, -0.5, -0.5});
    const World cut(scene);
    scene.nodes = {leaf(Cube{}, translation({-0.5, -0.5, -0.5}) * turn * scaling({1, 0.5, 1}))};
    const World whole(scene);
    for (int i = 0; i < 2'000; ++i) {
      const Ray r = random.towards_box(6, 0.8);
      ASSERT_EQ(boundaries(cut, r, ws), boundaries(whole, r, ws));
    }
  }
}

TEST(Csg, StackedBoxesAreOneFromInside) {
  Scene scene;
  scene.nodes = {inner(CsgOp::unite, 2), leaf(Cube{}), leaf(Cube{}, translation({0, 1, 0}))};
  const World world(scene);
  WorldWorkspace ws;
  RandomRays random(14);
  for (int i = 0; i < 5'000; ++i) {
    Ray r;
    r.origin = {random.uniform(0.1, 0.9), 0.5, random.uniform(0.1, 0.9)};
    r.direction = normalized(Vec3d{random.uniform(-0.05, 0.05), 1, random.uniform(-0.05, 0.05)});
    const auto b = first_boundary(world.parts(), RayQuery(r), ws);
    ASSERT_TRUE(b);
    ASSERT_NEAR((r.origin + r.direction * b->t).y, 2, 1e-12);
    ASSERT_FALSE(b->entering);
  }
}

TEST(Csg, TwoHalfSpacesThatCoverTheLineLeaveNoBoundary) {
  Scene scene;
  scene.nodes = {inner(CsgOp::exclusive_or, 2), leaf(Plane{}), leaf(Plane{}, rotation_deg(0, 180))};
  const World world(scene);
  CsgWorkspace ws;
  RandomRays random(15);
  for (int i = 0; i < 1'000; ++i) {
    const Ray r = random.towards_box(5, 5);
    ASSERT_EQ(boundaries(world, r, ws), 0);
    ASSERT_TRUE(gather(world.parts().items_of(world.parts().objects[0]), world.parts().leaves, RayQuery(r),
                       infinity, ws));
  }
}

}  // namespace
}  // namespace rayfarm
