// S13: a solid and its twin, placed by two chains of transforms that are the same in exact arithmetic.
// A xor A and A - A are empty; A and A, A or A have the boundaries of A.
#include "tests/stability/cases.h"
#include "tests/stability/textbook.h"

namespace rayfarm::stability {
namespace {

constexpr std::array<CsgOp, 4> all_operations{CsgOp::exclusive_or, CsgOp::subtract, CsgOp::intersect,
                                              CsgOp::unite};

/// Whether that many boundaries of `A op A` are wrong, when A and its twin alone have so many.
bool is_wrong(CsgOp op, std::size_t count, std::size_t alone, std::size_t twin_alone) {
  if (op == CsgOp::exclusive_or || op == CsgOp::subtract) return count > 0;
  return count != alone && count != twin_alone;
}

/// A half of the rays goes through the solid, a half past its edges: of a round solid nearly touching it, of one
/// with corners through points of an edge or corner.
Ray ray_at(const Solid& solid, const Affine& placed, double distance, RandomRays& random) {
  Vec3d target = random.in_box(1.2);
  const bool at_edge = random.uniform(0, 1) < 0.5;
  if (std::holds_alternative<Cube>(solid)) {
    target = random.in_box(0.6) + Vec3d{0.5, 0.5, 0.5};
    for (int axis = 0; at_edge && axis < 3; ++axis)
      if (random.uniform(0, 1) < 0.7) target[axis] = target[axis] < 0.5 ? 0 : 1;
  } else if (at_edge) {
    // Across the line of sight to the middle, one radius away but for a thousandth.
    const Vec3d from = random.direction(), across = normalized(cross(from, random.direction()));
    target = across * (1 + random.uniform(-1e-3, 1e-3));
    Ray ray;
    ray.origin = moved(placed, target + from * distance);
    ray.direction = normalized(moved(placed, target) - ray.origin);
    return ray;
  }
  return ray_towards(moved(placed, target), distance, random);
}

RunBatch ours(const Solid& solid) {
  return [solid](const Batch& batch) {
    RandomRays random(batch.seed);
    const auto [one, two] = twin_chains(random);
    const World alone(scene_of({solid_node(solid, one)})), twin_alone(scene_of({solid_node(solid, two)}));
    std::vector<World> worlds;
    for (const CsgOp op : all_operations)  // the sphere behind the moon keeps the pair from being two objects
      worlds.emplace_back(
          scene_of({operation_node(CsgOp::subtract, 2), operation_node(op, 2), solid_node(solid, one),
                    solid_node(solid, two), solid_node(Sphere{}, translation({1e9, 0, 0}))}));
    CsgWorkspace workspace;
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const std::size_t which = tally.rays % all_operations.size();
      const Ray ray = ray_at(solid, one, batch.driver, random);
      const auto count = [&](const World& world) { return boundaries_of(world, ray, workspace).size(); };
      tally.failures +=
          is_wrong(all_operations[which], count(worlds[which]), count(alone), count(twin_alone));
    }
    return tally;
  };
}

template <class T>
RunBatch textbook(const Solid& solid, const SameRule& same) {
  return [solid, same](const Batch& batch) {
    RandomRays random(batch.seed);
    const auto [one, two] = twin_chains(random);
    const TextbookLeaf<T> a(solid, one), b(solid, two);
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const CsgOp op = all_operations[tally.rays % all_operations.size()];
      const Ray ray = ray_at(solid, one, batch.driver, random);
      const TextbookSpans<T> in_a = a.spans(ray), in_b = b.spans(ray);
      std::array<T, 8> at{};
      const auto count = static_cast<std::size_t>(merged(op, in_a, in_b, same, at));
      tally.failures +=
          is_wrong(op, count, static_cast<std::size_t>(in_a.count), static_cast<std::size_t>(in_b.count));
    }
    return tally;
  };
}

Case twin_case(const std::string& name, const Solid& solid) {
  return {"S13 " + name,
          "xor, -, and, or of twins",
          "distance / size of the " + name,
          {10, 1e2, 1e3, 1e4, 1e5},
          {{"exact equality", "double", textbook<double>(solid, {"", 0, 0}), {}},
           {"absolute 1e-4", "double", textbook<double>(solid, {"", 1e-4, 0}), {}},
           {"relative 1e-12", "double", textbook<double>(solid, {"", 0, 1e-12}), {}},
           {"relative 1e-5", "float", textbook<float>(solid, {"", 0, 1e-5}), {}},
           {"ours", "double", ours(solid), 0.0}},
          {100'000, 100'000'000, 500}};
}

}  // namespace

std::vector<Case> twin_cases() {
  return {twin_case("sphere", Sphere{}), twin_case("box", Cube{}),
          twin_case("cylinder", Cylinder{-0.5, 0.75}), twin_case("torus", Torus{1, 0.25}),
          twin_case("spindle torus", Torus{0.5, 0.8})};
}

}  // namespace rayfarm::stability
