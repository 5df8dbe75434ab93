// S17: random CSG trees of boxes and half-spaces on a grid of quarters, where faces, edges and corners meet all
// the time, against membership in exact integers.
//
// A line in a face has no side there; it counts as moved a little along x, y and z (leaf.h says aside), by the
// same rule for all solids.
#include <numeric>

#include "tests/stability/cases.h"
#include "tests/stability/scenes.h"

namespace rayfarm::stability {
namespace {

using Whole = std::int64_t;  // coordinates are whole quarters

struct Slab {
  Whole low, high;  // of one axis
};
constexpr Whole endless = 1'000'000;

/// A box, or a half-space with its face across an axis.
struct GridSolid {
  std::array<Slab, 3> slabs;
};

struct Tree {
  std::vector<Node> nodes;
  std::vector<GridSolid> solids;  // by leaf, in preorder
};

class TreeMaker {
 public:
  explicit TreeMaker(RandomRays& random) : random_(random) {}

  Tree make(int depth) {
    add(depth, true);
    return std::move(tree_);
  }

 private:
  Whole whole(Whole low, Whole high) {
    return low + static_cast<Whole>(random_.uniform(0, 1) * static_cast<double>(high - low + 1));
  }

  void add(int depth, bool is_root) {
    if (!is_root && (depth == 0 || random_.uniform(0, 1) < 0.15)) return add_leaf();
    const auto op = static_cast<CsgOp>(whole(0, 3));
    const auto children = static_cast<std::uint32_t>(depth > 6 ? 2 : whole(2, 3));
    tree_.nodes.push_back(operation_node(op, children));
    // One long branch: a tree of twelve levels must not have 2^12 leaves.
    for (std::uint32_t i = 0; i < children; ++i) add(i == 0 ? depth - 1 : std::min(depth - 1, 1), false);
  }

  void add_leaf() {
    GridSolid solid;
    if (random_.uniform(0, 1) < 0.1) {
      const int axis = static_cast<int>(whole(0, 2));
      const Whole at = whole(-8, 8);
      solid.slabs.fill({-endless, endless});
      solid.slabs[static_cast<std::size_t>(axis)] = {-endless, at};
      // The face of plane{} looks along z; turned to x by the y axis, to y by the x axis.
      const Affine turn = axis == 0 ? rotation_deg(1, 90) : axis == 1 ? rotation_deg(0, -90) : Affine{};
      glm::dvec3 move{0};
      move[axis] = static_cast<double>(at) / 4;
      tree_.nodes.push_back(solid_node(Plane{}, translation(move) * turn));
    } else {
      glm::dvec3 move{0}, size{0};
      for (int axis = 0; axis < 3; ++axis) {
        const Whole low = whole(-8, 7), high = whole(low + 1, 8);
        solid.slabs[static_cast<std::size_t>(axis)] = {low, high};
        move[axis] = static_cast<double>(low) / 4, size[axis] = static_cast<double>(high - low) / 4;
      }
      tree_.nodes.push_back(solid_node(Cube{}, translation(move) * scaling(size)));
    }
    tree_.solids.push_back(solid);
  }

  RandomRays& random_;
  Tree tree_;
};

/// A ray of whole numbers: origin in quarters, so is the direction.
struct GridRay {
  std::array<Whole, 3> origin, direction;

  Ray ray() const {
    Ray r;
    for (int i = 0; i < 3; ++i) {
      r.origin[i] = static_cast<double>(origin[static_cast<std::size_t>(i)]) / 4;
      r.direction[i] = static_cast<double>(direction[static_cast<std::size_t>(i)]) / 4;
    }
    return r;
  }
};

GridRay random_ray(RandomRays& random) {
  const auto whole = [&](double half) {
    return static_cast<Whole>(std::floor(random.uniform(-half, half + 1)));
  };
  for (;;) {
    GridRay r{{whole(12), whole(12), whole(12)}, {whole(7), whole(7), whole(7)}};
    if (random.uniform(0, 1) < 0.3) r.direction[static_cast<std::size_t>(random.uniform(0, 3))] = 0;
    if (r.direction[0] != 0 || r.direction[1] != 0 || r.direction[2] != 0) return r;
  }
}

/// t = above / below, below > 0.
struct Fraction {
  Whole above, below;
  bool operator<(const Fraction& o) const { return above * o.below < o.above * below; }
  bool operator==(const Fraction& o) const { return above * o.below == o.above * below; }
  double value() const { return static_cast<double>(above) / static_cast<double>(below); }
};

Fraction middle_of(const Fraction& a, const Fraction& b) {
  return {a.above * b.below + b.above * a.below, 2 * a.below * b.below};
}

bool contains(const GridSolid& solid, const GridRay& ray, const Fraction& t) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Whole p = ray.origin[axis] * t.below + ray.direction[axis] * t.above;
    const Whole low = solid.slabs[axis].low * t.below, high = solid.slabs[axis].high * t.below;
    // On a face: as a little further along the axis.
    if (p < low || p >= high) return false;
  }
  return true;
}

/// Whether the tree contains the point; `node` and `leaf` go on behind the subtree.
bool contains(const Tree& tree, const GridRay& ray, const Fraction& t, std::size_t& node, std::size_t& leaf) {
  const auto* operation = std::get_if<Operation>(&tree.nodes[node++].content);
  if (!operation) return contains(tree.solids[leaf++], ray, t);
  bool value = contains(tree, ray, t, node, leaf);
  for (std::uint32_t i = 1; i < operation->children; ++i) {
    const bool next = contains(tree, ray, t, node, leaf);
    switch (operation->op) {
      case CsgOp::unite:
        value = value || next;
        break;
      case CsgOp::intersect:
        value = value && next;
        break;
      case CsgOp::subtract:
        value = value && !next;
        break;
      case CsgOp::exclusive_or:
        value = value != next;
    }
  }
  return value;
}

bool contains(const Tree& tree, const GridRay& ray, const Fraction& t) {
  std::size_t node = 0, leaf = 0;
  return contains(tree, ray, t, node, leaf);
}

/// Every t ahead at which the ray may change sides, with the origin in front and one beyond behind.
std::vector<Fraction> events_of(const Tree& tree, const GridRay& ray) {
  std::vector<Fraction> at{{0, 1}};
  for (const GridSolid& solid : tree.solids)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const Whole face : {solid.slabs[axis].low, solid.slabs[axis].high}) {
        const Whole d = ray.direction[axis], distance = face - ray.origin[axis];
        if (d == 0 || std::abs(face) == endless) continue;
        const Fraction t = d > 0 ? Fraction{distance, d} : Fraction{-distance, -d};
        if (t.above > 0) at.push_back(t);
      }
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  at.push_back({at.back().above + at.back().below, at.back().below});
  return at;
}

/// The sides of all objects of the world after t: inside any of them.
class Sides {
 public:
  Sides(const World& world, const Ray& ray, CsgWorkspace& ws) {
    for (const WorldObject& object : world.parts().objects) {
      const auto items = world.parts().items_of(object);
      inside_ += gather(items, world.parts().leaves, RayQuery(ray), infinity, ws);
      Boundary b;
      for (std::size_t next = 0; next_boundary(items, ws, next, b);)
        changes_.push_back({b.t, b.entering ? 1 : -1});
    }
    std::sort(changes_.begin(), changes_.end());
  }
  bool inside_at(double t) {
    for (; next_ < changes_.size() && changes_[next_].first < t; ++next_) inside_ += changes_[next_].second;
    return inside_ > 0;
  }

 private:
  int inside_ = 0;
  std::vector<std::pair<double, int>> changes_;
  std::size_t next_ = 0;
};

/// A tree a batch. What is counted are pieces of rays between events.
Tally run_ours(const Batch& batch) {
  RandomRays random(batch.seed);
  const Tree tree = TreeMaker(random).make(static_cast<int>(batch.driver));
  const World world(scene_of(tree.nodes));
  CsgWorkspace workspace;
  Tally tally;
  while (tally.rays < batch.rays) {
    const GridRay ray = random_ray(random);
    Sides sides(world, ray.ray(), workspace);
    const std::vector<Fraction> at = events_of(tree, ray);
    for (std::size_t i = 0; i + 1 < at.size(); ++i, ++tally.rays) {
      const Fraction t = middle_of(at[i], at[i + 1]);
      tally.failures += sides.inside_at(t.value()) != contains(tree, ray, t);
    }
  }
  return tally;
}

}  // namespace

std::vector<Case> random_tree_cases() {
  return {{"S17",
           "random trees on a grid: exact membership",
           "depth of the tree",
           {1, 2, 4, 8, 12},
           {{"ours", "double", run_ours, 0.0}},
           {400'000, 10'000'000, 200}}};
}

}  // namespace rayfarm::stability
