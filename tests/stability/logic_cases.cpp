// S18: what a solid tells of one line must agree with what it tells of others; S21: numbers at the ends of the range.
// After "test 3" of Geant4's solids: inside, distance in and distance out must not contradict each other.
#include "tests/stability/cases.h"
#include "tests/stability/scenes.h"
#include "tests/support/solid_definitions.h"

namespace rayfarm::stability {
namespace {

bool is_inside(const Leaf& leaf, const Vec3d& p, const Vec3d& direction) {
  Ray ray;
  ray.origin = p, ray.direction = direction;
  return crossings(leaf, RayQuery(ray)).starts_inside;
}

/// A point's side does not depend on the direction asked, nor on how far the ray came; between two crossings it is the
/// one they tell; a ray that starts at a crossing finds the rest of them.
bool contradicts_itself(const Leaf& leaf, double distance, RandomRays& random) {
  Ray ray;
  ray.direction = random.direction();
  ray.origin = random.in_box(1.5) - ray.direction * distance;
  const Crossings c = crossings(leaf, RayQuery(ray));
  bool inside = c.starts_inside;
  if (is_inside(leaf, ray.origin, random.direction()) != inside) return true;
  double from = 0;
  for (int k = 0; k < c.count; ++k) {
    const Crossing& at = c.at[static_cast<std::size_t>(k)];
    if (!(at.t >= from)) return true;
    const double apart = std::max(1e-6, 4 * at.error);
    if (at.t - from > apart &&
        is_inside(leaf, ray.origin + ray.direction * (0.5 * (from + at.t)), random.direction()) != inside)
      return true;
    inside = !inside, from = at.t;
  }
  if (c.count == 0) return false;
  const LocalRay<double> local = to_local(leaf, RayQuery(ray));
  const SurfacePoint s = surface_at(leaf, local, c.at[0].t, !c.starts_inside);
  const double steep = dot(s.normal, ray.direction) / length(s.normal);
  if (std::fabs(steep) < 1e-3) return false;
  if ((steep < 0) == c.starts_inside) return true;  // in against the normal, out along it
  const LocalRay<double> onward{s.point, ray.direction, 0, 0};
  const Crossings rest = crossings_from_surface(leaf, onward, steep < 0);
  const bool close = c.count > 1 && c.at[1].t - c.at[0].t < 1e-6;
  return !close && (rest.starts_inside == c.starts_inside || rest.count != c.count - 1);
}

RunBatch contradictions() {
  return [](const Batch& batch) {
    RandomRays random(batch.seed);
    std::vector<Leaf> leaves;
    for (const Solid& solid : all_solids()) leaves.push_back(make_leaf(solid, bounded(Affine{})));
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays)
      tally.failures += contradicts_itself(leaves[tally.rays % leaves.size()], batch.driver, random);
    return tally;
  };
}

/// Coordinates of about 10^exponent, directions as large or small, or zero, infinite, no number. What is found has
/// to be a number, or nothing.
RunBatch not_numbers() {
  return [](const Batch& batch) {
    RandomRays random(batch.seed);
    const double size = std::pow(10.0, batch.driver);
    const double odd[] = {0, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()};
    const std::vector<Solid> solids = all_solids();
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const Solid& solid = solids[tally.rays % solids.size()];
      const Leaf leaf = make_leaf(solid, bounded(tally.rays % 3 == 0 ? translation({size, 0, 0}) : Affine{}));
      Ray ray;
      ray.origin = random.in_box(1) * size;
      ray.direction = random.direction() * (random.uniform(0, 1) < 0.5 ? size : 1 / size);
      if (random.uniform(0, 1) < 0.2)
        ray.direction[static_cast<int>(random.uniform(0, 3))] = odd[static_cast<int>(random.uniform(0, 4))];
      if (random.uniform(0, 1) < 0.05) ray.direction = {};
      const Crossings c = crossings(leaf, RayQuery(ray));
      bool bad = c.count < 0 || c.count > 8;
      for (int k = 0; k < c.count && !bad; ++k) bad = std::isnan(c.at[static_cast<std::size_t>(k)].t);
      tally.failures += bad;
    }
    return tally;
  };
}

}  // namespace

std::vector<Case> logic_cases() {
  return {{"S18 logic",
           "solids that contradict themselves",
           "distance",
           {3, 1e2, 1e4, 1e6},
           {{"ours", "double", contradictions(), 0.0}}},
          {"S21 extremes",
           "crossings that are no numbers",
           "log10 of the coordinates",
           {-300, -150, -100, -30, 30, 100, 150, 300},
           {{"ours", "double", not_numbers(), 0.0}}}};
}

}  // namespace rayfarm::stability
