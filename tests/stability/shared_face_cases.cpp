// S12: a box with a pocket whose opening lies in the box's own face. Seen through the opening there must be no
// cap.
#include "tests/stability/cases.h"
#include "tests/stability/textbook.h"

namespace rayfarm::stability {
namespace {

/// The box [0,1]^3 less a box that shares a part of its face z = 1, through two chains of the same placement.
struct Pocket {
  explicit Pocket(RandomRays& random) {
    const auto [one, two] = twin_chains(random);
    box = one;
    tool = two * translation({0.25, 0.25, 0.5}) * scaling({0.5, 0.5, 0.5});
  }
  Affine box, tool;
};

/// A ray into the opening, and where it passes there.
struct Aimed {
  Ray ray;
  double opening;  // t
};

Aimed aimed(const Pocket& pocket, double distance, RandomRays& random) {
  const Vec3d target{random.uniform(0.27, 0.73), random.uniform(0.27, 0.73), 1};
  Vec3d up = random.direction();
  up.z = random.uniform(0.0175, 1);  // one degree or more above the face
  const Vec3d from = target + normalized(up) * distance;
  Aimed a;
  a.ray.origin = moved(pocket.box, from);
  const Vec3d towards = moved(pocket.box, target) - a.ray.origin;
  a.opening = length(towards);
  a.ray.direction = towards * (1 / a.opening);
  return a;
}

/// Walls and floor are at least 0.02 away from where the ray comes through the opening.
bool is_cap(const Aimed& a, double t) { return t < a.opening + 0.01; }

Tally run_ours(const Batch& batch) {
  RandomRays random(batch.seed);
  const Pocket pocket(random);
  const World world(scene_of(
      {operation_node(CsgOp::subtract, 2), solid_node(Cube{}, pocket.box), solid_node(Cube{}, pocket.tool)}));
  WorldWorkspace workspace;
  Tally tally;
  for (; tally.rays < batch.rays; ++tally.rays) {
    const Aimed a = aimed(pocket, batch.driver, random);
    const auto b = first_boundary(world.parts(), RayQuery(a.ray), workspace);
    tally.failures += !b || !b->entering || is_cap(a, b->t);
  }
  return tally;
}

template <class T>
RunBatch textbook(const SameRule& same) {
  return [same](const Batch& batch) {
    RandomRays random(batch.seed);
    const Pocket pocket(random);
    const TextbookLeaf<T> box(Cube{}, pocket.box), tool(Cube{}, pocket.tool);
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const Aimed a = aimed(pocket, batch.driver, random);
      std::array<T, 8> at{};
      const int count = merged(CsgOp::subtract, box.spans(a.ray), tool.spans(a.ray), same, at);
      tally.failures += count == 0 || is_cap(a, double(at[0]));
    }
    return tally;
  };
}

}  // namespace

std::vector<Case> shared_face_cases() {
  return {{"S12",
           "A - B with a shared face: caps seen",
           "distance / size of the box",
           {1, 10, 1e2, 1e3, 1e4, 1e5, 1e6},
           {{"exact equality", "double", textbook<double>({"", 0, 0}), {}},
            {"absolute 1e-9", "double", textbook<double>({"", 1e-9, 0}), {}},
            {"relative 1e-12", "double", textbook<double>({"", 0, 1e-12}), {}},
            {"relative 1e-5", "float", textbook<float>({"", 0, 1e-5}), {}},
            {"ours", "double", run_ours, 0.0}},
           {200'000, 100'000'000, 500}}};
}

}  // namespace rayfarm::stability
