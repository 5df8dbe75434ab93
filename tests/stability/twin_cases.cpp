// S13: a solid and its twin, placed by two chains of transforms that are the same in exact arithmetic.
// A xor A and A - A are empty; A and A, A or A have the boundaries of A.
#include "tests/stability/cases.h"
#include "tests/stability/textbook.h"
#include "tests/support/surfaces.h"

namespace rayfarm::stability {
namespace {

constexpr std::array<CsgOp, 4> all_operations{CsgOp::exclusive_or, CsgOp::subtract, CsgOp::intersect,
                                              CsgOp::unite};

/// Whether that many boundaries of `A op A` are wrong, when A and its twin alone have so many.
bool is_wrong(CsgOp op, std::size_t count, std::size_t alone, std::size_t twin_alone) {
  if (op == CsgOp::exclusive_or || op == CsgOp::subtract) return count > 0;
  return count != alone && count != twin_alone;
}

struct Subject {
  Solid solid;
  std::vector<Asset> assets{};  // of a mesh
};

/// Rays at a solid as it is placed: a half goes through it. The others come past what is hard of it: of one with corners
/// through points of an edge or corner, of any other along a plane that touches it but for a thousandth.
class Aim {
 public:
  explicit Aim(const Subject& subject) : leaf_(make_leaf(subject.solid, BoundedAffine{})) {
    if (!subject.assets.empty()) mesh_ = &std::get<TriangleMesh>(*subject.assets[0].content());
  }

  Ray ray_at(const Affine& placed, double distance, RandomRays& random) const {
    if (random.uniform(0, 1) < 0.5) return ray_towards(moved(placed, any_point(random)), distance, random);
    if (mesh_) return ray_towards(moved(placed, point_of_mesh_edge(random)), distance, random);
    if (is_cube()) return ray_towards(moved(placed, point_of_cube_edge(random)), distance, random);
    const SurfacePoint touched = point_of_surface(random);
    const Vec3d normal = normalized(touched.normal), from = normalized(cross(normal, random.direction()));
    const Vec3d target = touched.point + normal * random.uniform(-1e-3, 1e-3);
    Ray ray;
    ray.origin = moved(placed, target + from * distance);
    ray.direction = normalized(moved(placed, target) - ray.origin);
    return ray;
  }

 private:
  bool is_cube() const { return std::holds_alternative<Cube>(leaf_.solid); }
  bool is_box() const { return is_cube() || std::holds_alternative<RoundedCube>(leaf_.solid); }

  Vec3d any_point(RandomRays& random) const {
    return is_box() ? random.in_box(0.6) + Vec3d{0.5, 0.5, 0.5} : random.in_box(1.2);
  }
  Vec3d point_of_cube_edge(RandomRays& random) const {
    Vec3d p = any_point(random);
    for (int axis = 0; axis < 3; ++axis)
      if (random.uniform(0, 1) < 0.7) p[axis] = p[axis] < 0.5 ? 0 : 1;
    return p;
  }
  Vec3d point_of_mesh_edge(RandomRays& random) const {
    const auto number =
        static_cast<std::size_t>(random.uniform(0, static_cast<double>(mesh_->triangles.size())));
    const double share = std::clamp(random.uniform(-0.2, 1.2), 0.0, 1.0);
    const IndexTriple& t = mesh_->triangles[number];
    return mesh_->points[t[0]] * (1 - share) + mesh_->points[t[1]] * share;
  }
  SurfacePoint point_of_surface(RandomRays& random) const {
    for (;;) {
      const RayQuery ray(random.towards_box(4, 1));
      const Crossings c = crossings(leaf_, ray);
      if (c.count > 0) return surface_at(leaf_, to_local(leaf_, ray), c.at[0].t, !c.starts_inside);
    }
  }

  Leaf leaf_;
  const TriangleMesh* mesh_ = nullptr;
};

World world_of(std::vector<Node> nodes, const Subject& subject) {
  Scene scene = scene_of(std::move(nodes));
  scene.assets = subject.assets;
  return World(std::move(scene));
}

RunBatch ours(const Subject& subject) {
  return [subject](const Batch& batch) {
    RandomRays random(batch.seed);
    const auto [one, two] = twin_chains(random);
    const Node first = solid_node(subject.solid, one), twin = solid_node(subject.solid, two);
    const World alone = world_of({first}, subject), twin_alone = world_of({twin}, subject);
    std::vector<World> worlds;
    for (const CsgOp op : all_operations)  // the sphere behind the moon keeps the pair from being two objects
      worlds.push_back(world_of({operation_node(CsgOp::subtract, 2), operation_node(op, 2), first, twin,
                                 solid_node(Sphere{}, translation({1e9, 0, 0}))},
                                subject));
    const Aim aim(subject);
    CsgWorkspace workspace;
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const std::size_t which = tally.rays % all_operations.size();
      const Ray ray = aim.ray_at(one, batch.driver, random);
      const auto count = [&](const World& world) { return boundaries_of(world, ray, workspace).size(); };
      tally.failures +=
          is_wrong(all_operations[which], count(worlds[which]), count(alone), count(twin_alone));
    }
    return tally;
  };
}

template <class T>
RunBatch textbook(const Subject& subject, const SameRule& same) {
  return [subject, same](const Batch& batch) {
    RandomRays random(batch.seed);
    const auto [one, two] = twin_chains(random);
    const TextbookLeaf<T> a(subject.solid, one), b(subject.solid, two);
    const Aim aim(subject);
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const CsgOp op = all_operations[tally.rays % all_operations.size()];
      const Ray ray = aim.ray_at(one, batch.driver, random);
      const TextbookSpans<T> in_a = a.spans(ray), in_b = b.spans(ray);
      std::array<T, 8> at{};
      const auto count = static_cast<std::size_t>(merged(op, in_a, in_b, same, at));
      tally.failures +=
          is_wrong(op, count, static_cast<std::size_t>(in_a.count), static_cast<std::size_t>(in_b.count));
    }
    return tally;
  };
}

/// Of a mesh there are no textbook's crossings to merge.
Case twin_case(const std::string& name, const Subject& subject) {
  Case c{"S13 " + name,
         "xor, -, and, or of twins",
         "distance / size of the " + name,
         {10, 1e2, 1e3, 1e4, 1e5},
         {},
         {100'000, 100'000'000, 500}};
  if (subject.assets.empty())
    c.methods = {{"exact equality", "double", textbook<double>(subject, {"", 0, 0}), {}},
                 {"absolute 1e-4", "double", textbook<double>(subject, {"", 1e-4, 0}), {}},
                 {"relative 1e-12", "double", textbook<double>(subject, {"", 0, 1e-12}), {}},
                 {"relative 1e-5", "float", textbook<float>(subject, {"", 0, 1e-5}), {}}};
  c.methods.push_back({"ours", "double", ours(subject), 0.0});
  return c;
}

}  // namespace

std::vector<Case> twin_cases() {
  return {twin_case("sphere", {Sphere{}}),
          twin_case("box", {Cube{}}),
          twin_case("rounded box", {RoundedCube{0.2}}),
          twin_case("cylinder", {Cylinder{-0.5, 0.75}}),
          twin_case("cone", {Cone{-0.75, 1}}),
          twin_case("torus", {Torus{1, 0.25}}),
          twin_case("spindle torus", {Torus{0.5, 0.8}}),
          twin_case("mesh", {Mesh{0, false}, {Asset("ball", ball_mesh(6, 9))}})};
}

}  // namespace rayfarm::stability
