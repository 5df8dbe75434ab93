// S16: the Menger sponge as a cube with square bars taken out, at levels up to five: thousands of faces, all of
// them shared. Between two planes of its grid a ray is inside or not by the ternary digits of where it is.
#include "tests/stability/cases.h"
#include "tests/stability/quad.h"
#include "tests/stability/scenes.h"

namespace rayfarm::stability {
namespace {

struct Sponge {
  std::vector<Node> nodes;
  int level = 1;

  /// The bars along one axis whose cross-section lies in a square of the other two: the middle one of nine
  /// parts, and those of the eight around it, down to the last level.
  void add_bars(int axis, double x, double y, double side, int levels_left) {
    const std::uint32_t parts = levels_left > 1 ? 9 : 1;
    if (parts > 1) nodes.push_back(operation_node(CsgOp::unite, parts));
    nodes.push_back(solid_node(Cube{}, bar(axis, x + side / 3, y + side / 3, side / 3)));
    if (levels_left == 1) return;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        if (i != 1 || k != 1) add_bars(axis, x + i * side / 3, y + k * side / 3, side / 3, levels_left - 1);
  }

  /// Through the whole cube, its ends in the cube's own faces.
  static Affine bar(int axis, double x, double y, double side) {
    glm::dvec3 scale(side), move{0};
    scale[axis] = 1;
    move[(axis + 1) % 3] = x, move[(axis + 2) % 3] = y;
    return translation(move) * scaling(scale);
  }
};

/// Cube and bars through two chains of the same placement, in turn.
World sponge_of(int level, const std::array<Affine, 2>& placed) {
  Sponge sponge;
  sponge.nodes = {operation_node(CsgOp::subtract, 4), solid_node(Cube{}, placed[0])};
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t group = sponge.nodes.size();
    sponge.add_bars(axis, 0, 0, 1, level);
    Affine& map = sponge.nodes[group].parent_from_node;
    map = placed[static_cast<std::size_t>((axis + 1) % 2)] * map;
  }
  return World(scene_of(std::move(sponge.nodes)));
}

bool is_in_sponge(QuadVec p, int level) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(p[axis] > 0 && p[axis] < 1)) return false;
  for (int k = 0; k < level; ++k) {
    int ones = 0;
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = p[axis] * 3;
      const int digit = static_cast<int>(p[axis]);
      p[axis] = p[axis] - Quad(digit);
      ones += digit == 1;
    }
    if (ones >= 2) return false;
  }
  return true;
}

/// Where the ray crosses the planes of the grid.
std::vector<Quad> grid_crossings(const QuadRay& ray, int cells) {
  std::vector<Quad> at;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k <= cells && ray.direction[axis] != 0; ++k)
      at.push_back((Quad(k) / Quad(cells) - ray.origin[axis]) / ray.direction[axis]);
  std::sort(at.begin(), at.end());
  return at;
}

/// From outside the cube towards a point of it; a third of the rays through a corner of the grid, a third through
/// an edge of it, some of them along an axis.
Ray ray_through(int cells, RandomRays& random) {
  Vec3d target{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
  const int snapped = static_cast<int>(random.uniform(0, 3));
  for (int axis = 0; axis < 3 && snapped > 0; ++axis)
    if (axis + snapped > 1 || snapped == 2) target[axis] = std::floor(target[axis] * cells) / cells;
  Ray ray = ray_towards(target, random.uniform(2, 5), random);
  if (random.uniform(0, 1) < 0.1) {
    const int axis = static_cast<int>(random.uniform(0, 3));
    ray.direction = Vec3d{}, ray.direction[axis] = 1;
    ray.origin = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
    ray.origin[axis] = -2;
  }
  return ray;
}

/// Whether rounding of coordinates up to 12 may put the point on the other side of one of the grid's planes.
bool is_at_plane(const QuadVec& p, int cells) {
  for (int axis = 0; axis < 3; ++axis) {
    const Quad scaled = p[axis] * cells, off = scaled - floorq(scaled + Quad(0.5));
    if (fabs(off) < 64 * 12 * unit_roundoff * cells) return true;
  }
  return false;
}

/// Looks at the middle of each piece between planes, and, where rounding decides about none of them, whether
/// there are as many boundaries (ascending t, from outside) as there are changes.
bool differs(const QuadRay& ray, int level, int cells, const std::vector<double>& boundaries) {
  const std::vector<Quad> at = grid_crossings(ray, cells);
  std::size_t passed = 0, changes = 0;
  bool was_inside = false, is_clear = true;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if (at[i] < 0) continue;
    const Quad middle = (at[i] + at[i + 1]) / 2;
    const QuadVec p = ray.origin + ray.direction * middle;
    if (is_at_plane(p, cells)) {
      is_clear = false;
      continue;
    }
    const bool is_inside = is_in_sponge(p, level);
    changes += is_inside != was_inside, was_inside = is_inside;
    while (passed < boundaries.size() && boundaries[passed] < static_cast<double>(middle)) ++passed;
    if ((passed % 2 == 1) != is_inside) return true;
  }
  return is_clear && boundaries.size() != changes + was_inside;  // the last one is the way out
}

Ray through(const Affine& map, Ray ray) {
  ray.direction = moved(map, ray.origin + ray.direction);
  ray.origin = moved(map, ray.origin);
  ray.direction = ray.direction - ray.origin;
  return ray;
}

int cells_of(int level) { return level == 0 ? 1 : 3 * cells_of(level - 1); }

/// `boundaries(world, ray, workspace)`: where the side changes.
template <class Boundaries>
RunBatch counting(Boundaries boundaries) {
  return [boundaries](const Batch& batch) {
    RandomRays random(batch.seed);
    const int level = static_cast<int>(batch.driver), cells = cells_of(level);
    const std::array<Affine, 2> placed = twin_chains(random);
    const QuadAffine local_from_world = inverse(quad(placed[0]));
    const World world = sponge_of(level, placed);
    CsgWorkspace workspace;
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const Ray ray = through(placed[0], ray_through(cells, random));
      tally.failures +=
          differs(moved(local_from_world, quad(ray)), level, cells, boundaries(world, ray, workspace));
    }
    return tally;
  };
}

std::vector<double> our_boundaries(const World& world, const Ray& ray, CsgWorkspace& workspace) {
  std::vector<double> at;
  for (const Boundary& b : boundaries_of(world, ray, workspace)) at.push_back(b.t);
  return at;
}

/// The same crossings, each an event of its own unless equal to the last bit.
std::vector<double> boundaries_by_equality(const World& world, const Ray& ray, CsgWorkspace& ws) {
  const auto items = world.parts().items_of(world.parts().objects[0]);
  gather(items, world.parts().leaves, RayQuery(ray), infinity, ws);
  for (CsgWorkspace::Event& e : ws.events) e.error = 0;
  std::sort(ws.events.begin(), ws.events.end(),
            [](const auto& a, const auto& b) { return a.t != b.t ? a.t < b.t : a.item < b.item; });
  std::vector<double> at;
  Boundary b;
  for (std::size_t next = 0; next_boundary(items, ws, next, b);) at.push_back(b.t);
  return at;
}

}  // namespace

std::vector<Case> menger_cases() {
  return {{"S16",
           "Menger sponge: ternary digits say otherwise",
           "level",
           {1, 2, 3, 4, 5},
           {{"exact equality", "double", counting(boundaries_by_equality), {}},
            {"ours", "double", counting(our_boundaries), 0.0}},
           {4'000, 10'000'000, 2'000}}};
}

}  // namespace rayfarm::stability
