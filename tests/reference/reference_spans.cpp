#include "tests/reference/reference_spans.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/reference/reference_surfaces.h"

namespace rayfarm::reference {
namespace {

// A secondary ray does not meet the surfaces that lie this part of their coordinates in front of its start.
constexpr Real left_behind = 1e-12L;

Real size_of(const Vec& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

Spans spans_of_leaf(const Leaf& leaf, const Ray& local, const Rules& rules) {
  if (!leaf.surface) return rules.spans(leaf.solid, local);
  const std::vector<Crossing> crossings = crossings_of(*leaf.surface, local);
  return leaf.surface->closed ? spans_of_closed(crossings, local) : rules.of_sheet(crossings, local);
}

}  // namespace

Spans spans_of(const Leaf& leaf, int number, const Ray& ray, const Rules& rules) {
  const Ray local{leaf.local_from_world * (ray.origin - leaf.offset), leaf.local_from_world * ray.direction};
  Spans spans = spans_of_leaf(leaf, local, rules);
  bool inside = spans.starts_inside;
  for (Crossing& c : spans.crossings) {
    const Vec p = local.origin + (c.t + c.to_point) * local.direction;
    c.leaf = number;
    c.entering = inside = !inside;
    c.normal = glm::normalize(glm::transpose(leaf.local_from_world) * c.gradient);
    c.size = size_of(ray.origin) + size_of(leaf.offset);
    for (int axis = 0; axis < 3; ++axis) c.size += size_of(leaf.world_from_local[axis] * p[axis]);
  }
  return spans;
}

namespace {

Real speed_across(const Crossing& c, const Ray& ray) { return std::abs(glm::dot(c.normal, ray.direction)); }

bool coincide(const Crossing& a, const Crossing& b, const Ray& ray, Real coincidence) {
  const Real apart = std::abs(a.t - b.t) * std::min(speed_across(a, ray), speed_across(b, ray));
  return a.t == b.t || apart <= coincidence * std::max(a.size, b.size);
}

bool holds(CsgOp op, bool left, bool right) {
  switch (op) {
    case CsgOp::unite:
      return left || right;
    case CsgOp::intersect:
      return left && right;
    case CsgOp::subtract:
      return left && !right;
    case CsgOp::exclusive_or:
      return left != right;
  }
  std::abort();
}

// Walks both lists in the order of t. At equal t both sides flip and the left crossing is the one kept.
Spans combine(CsgOp op, const Spans& left, const Spans& right, const Ray& ray, Real coincidence) {
  bool in_left = left.starts_inside, in_right = right.starts_inside, inside = holds(op, in_left, in_right);
  Spans result{inside, {}};
  auto l = left.crossings.begin(), r = right.crossings.begin();
  while (l != left.crossings.end() || r != right.crossings.end()) {
    bool take_left = l != left.crossings.end(), take_right = r != right.crossings.end();
    if (take_left && take_right && !coincide(*l, *r, ray, coincidence))
      (l->t < r->t ? take_right : take_left) = false;
    const Crossing& kept = take_left ? *l : *r;
    if (take_left) in_left = !in_left, ++l;
    if (take_right) in_right = !in_right, ++r;
    if (holds(op, in_left, in_right) == inside) continue;
    inside = !inside;
    result.crossings.push_back(kept);
    result.crossings.back().entering = inside;
  }
  return result;
}

// Reads one subtree in preorder; `node` and `leaf` move behind it.
Spans spans_of_subtree(const Scene& scene, const std::vector<Leaf>& leaves, const Ray& ray,
                       const Rules& rules, std::size_t& node, int& leaf) {
  const Node& root = scene.nodes[node++];
  if (std::holds_alternative<Glow>(root.content)) return {};
  const auto* operation = std::get_if<Operation>(&root.content);
  if (operation == nullptr) {
    const int number = leaf++;
    return spans_of(leaves[number], number, ray, rules);
  }
  Spans result;
  for (std::uint32_t child = 0; child < operation->children; ++child) {
    Spans next = spans_of_subtree(scene, leaves, ray, rules, node, leaf);
    if (child == 0) {
      result = std::move(next);
    } else if (next.starts_inside || !next.crossings.empty() || operation->op == CsgOp::intersect) {
      result = combine(operation->op, result, next, ray, rules.coincidence);
    }
  }
  return result;
}

struct Placed {
  std::vector<Leaf> leaves;
  std::vector<PlacedGlow> glows;
};

void place(const Scene& scene, Leaf inherited, std::size_t& index, Placed& placed) {
  const Node& node = scene.nodes[index++];
  const Mat linear(node.parent_from_node.linear);
  inherited.offset += inherited.world_from_local * Vec(node.parent_from_node.offset);
  inherited.world_from_local = inherited.world_from_local * linear;
  if (node.material) inherited.material = scene.materials.at(*node.material);
  if (node.color) inherited.color = node.color;
  inherited.no_shadow = inherited.no_shadow || node.no_shadow;
  inherited.textures.insert(inherited.textures.end(), node.textures.begin(), node.textures.end());
  if (const auto* operation = std::get_if<Operation>(&node.content)) {
    for (std::uint32_t child = 0; child < operation->children; ++child)
      place(scene, inherited, index, placed);
    return;
  }
  inherited.local_from_world = glm::inverse(inherited.world_from_local);
  if (const auto* glow = std::get_if<Glow>(&node.content)) {
    inherited.solid = std::holds_alternative<Sphere>(glow->shape) ? Solid(Sphere{}) : Solid(Cylinder{});
    placed.glows.push_back({*glow, std::move(inherited)});
    return;
  }
  inherited.solid = std::get<Solid>(node.content);
  if (const auto* mesh = std::get_if<Mesh>(&inherited.solid))
    inherited.surface = surface_of(*mesh, *scene.assets.at(mesh->asset).content());
  if (const auto* bezier = std::get_if<Bezier>(&inherited.solid))
    inherited.surface = surface_of(*bezier, *scene.assets.at(bezier->asset).content());
  placed.leaves.push_back(std::move(inherited));
}

Placed placed_parts(const Scene& scene) {
  Placed placed;
  std::size_t index = 0;
  place(scene, Leaf{}, index, placed);
  return placed;
}

}  // namespace

std::vector<Leaf> leaves_of(const Scene& scene) { return placed_parts(scene).leaves; }
std::vector<PlacedGlow> glows_of(const Scene& scene) { return placed_parts(scene).glows; }

Spans spans_of(const Scene& scene, const std::vector<Leaf>& leaves, const Ray& ray, const Rules& rules) {
  std::size_t node = 0;
  int leaf = 0;
  return spans_of_subtree(scene, leaves, ray, rules, node, leaf);
}

namespace {

void collect_parts(const Scene& scene, const std::vector<Leaf>& leaves, const Ray& ray, const Rules& rules,
                   std::size_t& node, int& leaf, std::vector<Spans>& parts) {
  const auto* operation = std::get_if<Operation>(&scene.nodes[node].content);
  if (operation == nullptr || operation->op != CsgOp::unite) {
    parts.push_back(spans_of_subtree(scene, leaves, ray, rules, node, leaf));
    return;
  }
  ++node;
  for (std::uint32_t child = 0; child < operation->children; ++child)
    collect_parts(scene, leaves, ray, rules, node, leaf, parts);
}

}  // namespace

std::vector<Spans> spans_of_parts(const Scene& scene, const std::vector<Leaf>& leaves, const Ray& ray,
                                  const Rules& rules) {
  std::size_t node = 0;
  int leaf = 0;
  std::vector<Spans> parts;
  collect_parts(scene, leaves, ray, rules, node, leaf, parts);
  return parts;
}

Real depth_across(const Crossing& crossing, const Ray& ray) {
  return crossing.t * speed_across(crossing, ray);
}

bool is_ahead(const Crossing& crossing, const Ray& ray) {
  return crossing.t > 0 && depth_across(crossing, ray) > left_behind * crossing.size;
}

}  // namespace rayfarm::reference
