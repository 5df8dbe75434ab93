// S14: glass slabs stacked face to face, each placed by a chain of its own. They are one block: a ray meets its
// outside, and inside it meets nothing before the far side.
#include "common/render/hit.h"
#include "common/render/shade.h"
#include "tests/stability/cases.h"
#include "tests/stability/textbook.h"

namespace rayfarm::stability {
namespace {

/// Slabs k <= z <= k + 1 of a block, all 0 <= x, y <= 1, in one random placement written in two ways.
struct Stack {
  Stack(int slabs, RandomRays& random) {
    const auto chains = twin_chains(random);
    block = chains[0];
    for (int k = 0; k < slabs; ++k)
      placed.push_back(chains[static_cast<std::size_t>(k % 2)] * translation({0, 0, double(k)}));
  }
  Affine block;
  std::vector<Affine> placed;
};

/// Towards a point inside the block or on a face between two slabs, at least 0.02 away from its outside.
Ray ray_into(const Stack& stack, RandomRays& random) {
  const double slabs = static_cast<double>(stack.placed.size());
  Vec3d target{random.uniform(0.02, 0.98), random.uniform(0.02, 0.98), random.uniform(0.02, slabs - 0.02)};
  if (random.uniform(0, 1) < 0.3 && slabs > 1) target.z = std::floor(1 + random.uniform(0, slabs - 1));
  return ray_towards(moved(stack.block, target), 3 * slabs, random);
}

/// How far outside the block a point is, in its own space; negative inside.
double height_above(const Affine& block_from_world, double slabs, const Vec3d& p) {
  const Vec3d q = moved(block_from_world, p);
  return std::max({-q.x, q.x - 1, -q.y, q.y - 1, -q.z, q.z - slabs});
}

Affine inverse_of(const Affine& m) {
  const glm::dmat3 back = glm::inverse(m.linear);
  return {back, -(back * m.offset)};
}

Tally run_ours(const Batch& batch) {
  RandomRays random(batch.seed);
  const Stack stack(static_cast<int>(batch.driver), random);
  const Affine block_from_world = inverse_of(stack.block);
  std::vector<Node> nodes{operation_node(CsgOp::unite, static_cast<std::uint32_t>(stack.placed.size()))};
  for (const Affine& placed : stack.placed) nodes.push_back(solid_node(Cube{}, placed));
  const World world(scene_of(std::move(nodes)));
  WorldWorkspace workspace;
  const auto is_at_outside = [&](const Hit& hit) {
    return std::fabs(height_above(block_from_world, batch.driver, hit.point)) < 1e-9;
  };
  const auto hit_of = [&](const Ray& ray) -> std::optional<Hit> {
    const RayQuery query(ray);
    const auto boundary = first_boundary(world.parts(), query, workspace);
    if (!boundary) return std::nullopt;
    return hit_at(world.parts(), query, *boundary);
  };
  Tally tally;
  for (; tally.rays < batch.rays; ++tally.rays) {
    const Ray ray = ray_into(stack, random);
    const std::optional<Hit> outer = hit_of(ray);
    if (!outer || !outer->entering || !is_at_outside(*outer)) {
      ++tally.failures;
      continue;
    }
    const std::optional<Vec3d> bent = refracted(-ray.direction, outer->normal, 1.5);
    const std::optional<Hit> inner = bent ? hit_of(ray_from(*outer, *bent, false)) : std::nullopt;
    tally.failures += !inner || inner->entering || !is_at_outside(*inner);
  }
  return tally;
}

/// The slabs' crossings sorted; two of neighbours that `same` calls one cancel each other.
RunBatch textbook(const SameRule& same) {
  return [same](const Batch& batch) {
    RandomRays random(batch.seed);
    const Stack stack(static_cast<int>(batch.driver), random);
    std::vector<TextbookLeaf<double>> leaves;
    for (const Affine& placed : stack.placed) leaves.emplace_back(Cube{}, placed);
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const Ray ray = ray_into(stack, random);
      std::vector<TextbookSpans<double>> parts;
      for (const auto& leaf : leaves)
        if (const auto spans = leaf.spans(ray); spans.count > 0) parts.push_back(spans);
      std::sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.at[0] < b.at[0]; });
      bool is_whole = !parts.empty();
      for (std::size_t i = 1; i < parts.size(); ++i)
        is_whole =
            is_whole && (parts[i].at[0] < parts[i - 1].at[1] || same(parts[i - 1].at[1], parts[i].at[0]));
      tally.failures += !is_whole;
    }
    return tally;
  };
}

}  // namespace

std::vector<Case> stacked_slab_cases() {
  return {{"S14",
           "stacked glass slabs: internal faces seen",
           "slabs",
           {2, 5, 10, 20, 50},
           {{"exact equality", "double", textbook({"", 0, 0}), {}},
            {"absolute 1e-15", "double", textbook({"", 1e-15, 0}), {}},
            {"ours", "double", run_ours, 0.0}},
           {50'000, 100'000'000, 500}}};
}

}  // namespace rayfarm::stability
