// S4: solids placed by long chains of transforms; S15: walls so thin that bounds must not swallow them.
#include "common/render/hit.h"
#include "tests/stability/cases.h"
#include "tests/stability/naive_quadrics.h"
#include "tests/stability/quad_solids.h"
#include "tests/stability/scenes.h"

namespace rayfarm::stability {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// S4. -------------------------------------------------------------------------------------------------------

/// A sphere below a chain of nodes: turns, moves, and scales, mirrors and shears that together stay within 10^6.
struct Chain {
  Chain(int depth, RandomRays& random) {
    for (int i = 0; i < depth; ++i) {
      const auto factor = [&] { return std::pow(10.0, random.uniform(-2, 2) / depth); };
      const Vec3d by = random.in_box(1);
      const glm::dvec3 axis{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)};
      const double mirror = random.uniform(0, 1) < 0.3 ? -1 : 1;
      Affine shear;
      shear.linear[1][0] = random.uniform(-1, 1) / depth;
      nodes.push_back(translation({by.x, by.y, by.z}) * rotation_deg(axis, random.uniform(-180, 180)) *
                      scaling({factor(), factor(), mirror * factor()}) * shear);
      world_from_local = world_from_local * quad(nodes.back());
    }
  }
  std::vector<Affine> nodes;
  QuadAffine world_from_local;
};

Ray ray_at(const Chain& chain, RandomRays& random) {
  const Vec3d target = random.direction() * 0.7;
  const QuadVec at = point(chain.world_from_local, quad(target));
  return ray_towards({static_cast<double>(at.x), static_cast<double>(at.y), static_cast<double>(at.z)}, 100,
                     random);
}

double size_of(const QuadAffine& m) {
  Quad sum = 0;
  for (const QuadVec& row : m.row) sum = std::max(sum, fabs(row.x) + fabs(row.y) + fabs(row.z));
  return static_cast<double>(sum);
}

struct ChainHit {
  bool hit = false;
  double t = 0;
  Vec3d normal{};
};

/// Farther off than 16 eps times the condition of the chain, for rays that do not graze; or a normal along the ray.
template <class MakeMethod>
RunBatch off_in_chain(MakeMethod make) {
  return [make](const Batch& batch) {
    RandomRays random(batch.seed);
    const Chain chain(static_cast<int>(batch.driver), random);
    const QuadAffine back = inverse(chain.world_from_local);
    const double condition = size_of(chain.world_from_local) * size_of(back);
    auto method = make(chain);
    Tally tally;
    while (tally.rays < batch.rays) {
      const Ray ray = ray_at(chain, random);
      const QuadRay local = moved(back, quad(ray));
      const QuadSpans truth = quad_spans(Sphere{}, local);
      if (truth.at.size() != 2 || truth.at[0] < 0) continue;
      const QuadVec n = local.origin + local.direction * truth.at[0];
      if (static_cast<double>(-dot(n, unit(local.direction))) < 0.3) continue;
      ++tally.rays;
      const ChainHit found = method(ray);
      const double off = static_cast<double>(fabs(truth.at[0] - Quad(found.t))) * length(ray.direction);
      const double scale = length(ray.origin) + static_cast<double>(length(chain.world_from_local.offset));
      tally.failures +=
          !found.hit || off > 16 * eps * condition * scale || dot(found.normal, ray.direction) >= 0;
    }
    return tally;
  };
}

auto ours_in_chain(const Chain& chain) {
  std::vector<Node> nodes;
  for (const Affine& m : chain.nodes) nodes.push_back({Operation{CsgOp::unite, 1}, m, {}, {}, {}, {}});
  nodes.push_back(solid_node(Sphere{}));
  return [world = World(scene_of(std::move(nodes))),
          workspace = WorldWorkspace{}](const Ray& ray) mutable -> ChainHit {
    const RayQuery query(ray);
    const auto boundary = first_boundary(world.parts(), query, workspace);
    if (!boundary) return {};
    return {true, boundary->t, hit_at(world.parts(), query, *boundary).normal};
  };
}

/// The ray moved through one inverse after the other; the normal as the cross product of moved tangents, which a
/// mirror turns around.
auto chained_inverses(const Chain& chain) {
  return [nodes = chain.nodes](const Ray& ray) -> ChainHit {
    glm::dvec3 o{ray.origin.x, ray.origin.y, ray.origin.z},
        d{ray.direction.x, ray.direction.y, ray.direction.z};
    for (const Affine& m : nodes) {
      const glm::dmat3 back = glm::inverse(m.linear);
      o = back * (o - m.offset), d = back * d;
    }
    const Roots<double> roots = plain_roots(unit_sphere<double>, vec(o), vec(d));
    if (!roots.real) return {};
    const Vec3d n = vec(o + d * roots.first), any = std::fabs(n.x) > 0.5 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d along = cross(n, any), across = cross(n, along);
    glm::dvec3 u{along.x, along.y, along.z}, v{across.x, across.y, across.z};
    for (auto m = nodes.rbegin(); m != nodes.rend(); ++m) u = m->linear * u, v = m->linear * v;
    return {true, roots.first, vec(glm::cross(u, v))};
  };
}

// S15. ------------------------------------------------------------------------------------------------------

constexpr double wall_distance = 10;

/// A square wall, moved and turned, seen from 10 units under angles from 20 degrees up.
struct Wall {
  Wall(double thickness, RandomRays& random) {
    const Vec3d by = random.in_box(2);
    const glm::dvec3 axis{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)};
    placed = translation({by.x, by.y, by.z}) * rotation_deg(axis, random.uniform(-180, 180)) *
             scaling({thickness * wall_distance, 1, 1});
  }
  Affine placed;
};

Ray ray_at(const Wall& wall, RandomRays& random) {
  const glm::dmat3& m = wall.placed.linear;
  const Vec3d across = normalized(vec(m[0]));
  for (;;) {
    const Vec3d target = moved(wall.placed, {0.5, random.uniform(0.01, 0.99), random.uniform(0.01, 0.99)});
    const Ray ray = ray_towards(target, wall_distance, random);
    if (std::fabs(dot(ray.direction, across)) > 0.35) return ray;
  }
}

/// Alone, cut out of a block, and with another solid taken away from it.
Tally ours_at_wall(const Batch& batch) {
  RandomRays random(batch.seed);
  const Wall wall(batch.driver, random);
  const Node node = solid_node(Cube{}, wall.placed), block = solid_node(Sphere{}, scaling({99, 99, 99})),
             moon = solid_node(Sphere{}, translation({999, 0, 0}));
  const World alone(scene_of({node})), hole(scene_of({operation_node(CsgOp::subtract, 2), block, node})),
      cut(scene_of({operation_node(CsgOp::subtract, 2), node, moon}));
  CsgWorkspace workspace;
  WorldWorkspace of_world;
  Tally tally;
  for (; tally.rays < batch.rays; ++tally.rays) {
    const Ray ray = ray_at(wall, random);
    const bool kept = first_boundary(alone.parts(), RayQuery(ray), of_world).has_value() &&
                      boundaries_of(cut, ray, workspace).size() == 2 &&
                      boundaries_of(hole, ray, workspace).size() == 3;
    tally.failures += !kept;
  }
  return tally;
}

/// Crossings nearer than a part of t, or than a length, are one.
RunBatch merged_by(double absolute, double relative) {
  return [=](const Batch& batch) {
    RandomRays random(batch.seed);
    const Wall wall(batch.driver, random);
    const Leaf leaf = make_leaf(Cube{}, bounded(wall.placed));
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const Interval<double> i = interval_of(Cube{}, to_local(leaf, RayQuery(ray_at(wall, random))));
      tally.failures += !(i.leave.t - i.enter.t > absolute + relative * i.enter.t);
    }
    return tally;
  };
}

}  // namespace

std::vector<Case> transform_cases() {
  return {{"S4 chain",
           "spheres below chains of transforms",
           "nodes",
           {1, 2, 5, 10, 20, 30},
           {{"chained inverses", "double", off_in_chain(chained_inverses), {}},
            {"ours", "double", off_in_chain(ours_in_chain), 0.0}},
           {20'000, 100'000'000, 100}},
          {"S15 wall",
           "thin walls lost",
           "thickness / distance",
           {64 * eps, 1e-13, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2},
           {{"absolute 1e-4", "double", merged_by(1e-4, 0), {}},
            {"relative 1e-12", "double", merged_by(0, 1e-12), {}},
            {"ours", "double", ours_at_wall, 0.0}},
           {100'000, 100'000'000, 100}}};
}

}  // namespace rayfarm::stability
