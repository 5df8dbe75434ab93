#include "tests/reference/reference_spans.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "tests/reference/reference_torus.h"

namespace rayfarm::reference {
namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();

// A secondary ray does not meet the surfaces that lie this part of their coordinates in front of its start.
constexpr Real left_behind = 1e-12L;

// A convex solid's part of the line, cut down by one boundary after the other.
struct Chord {
  Real enter = -infinity, leave = infinity;
  Vec enter_gradient{0}, leave_gradient{0};

  void clip(Real t0, const Vec& g0, Real t1, const Vec& g1) {
    if (t0 > enter) enter = t0, enter_gradient = g0;
    if (t1 < leave) leave = t1, leave_gradient = g1;
  }
  void clip_all() { enter = infinity, leave = -infinity; }
};

// Keeps what has dot(gradient, p) < limit.
void clip_half_space(Chord& chord, const Ray& ray, const Vec& gradient, Real limit) {
  if (std::isinf(limit)) return;
  const Real excess = glm::dot(gradient, ray.origin) - limit, slope = glm::dot(gradient, ray.direction);
  if (slope > 0) chord.clip(-infinity, gradient, -excess / slope, gradient);
  if (slope < 0) chord.clip(-excess / slope, gradient, infinity, gradient);
  if (slope == 0 && excess >= 0) chord.clip_all();
}

// Keeps what is nearer than 1 to the origin, the components that `axes` makes zero not counted.
void clip_unit_ball(Chord& chord, const Ray& ray, const Vec& axes) {
  const Vec o = ray.origin * axes, d = ray.direction * axes;
  const Real dd = glm::dot(d, d);
  if (dd == 0) {
    if (glm::dot(o, o) >= 1) chord.clip_all();
    return;
  }
  const Real t_closest = -glm::dot(o, d) / dd;
  const Vec closest = o + t_closest * d;
  const Real rest = 1 - glm::dot(closest, closest);
  if (rest <= 0) return chord.clip_all();
  const Real half = std::sqrt(rest / dd);
  chord.clip(t_closest - half, closest - half * d, t_closest + half, closest + half * d);
}

Chord chord_of(const Sphere&, const Ray& ray) {
  Chord chord;
  clip_unit_ball(chord, ray, Vec(1, 1, 1));
  return chord;
}

Chord chord_of(const Cube&, const Ray& ray) {
  Chord chord;
  for (int axis = 0; axis < 3; ++axis) {
    Vec out(0);
    out[axis] = 1;
    clip_half_space(chord, ray, -out, 0);
    clip_half_space(chord, ray, out, 1);
  }
  return chord;
}

Chord chord_of(const Plane&, const Ray& ray) {
  Chord chord;
  clip_half_space(chord, ray, Vec(0, 0, 1), 0);
  return chord;
}

Chord chord_of(const Cylinder& cylinder, const Ray& ray) {
  Chord chord;
  clip_unit_ball(chord, ray, Vec(1, 1, 0));
  clip_half_space(chord, ray, Vec(0, 0, -1), -Real(cylinder.z_min));
  clip_half_space(chord, ray, Vec(0, 0, 1), cylinder.z_max);
  return chord;
}

Spans spans_of_chord(const Chord& chord) {
  Spans spans;
  if (!(chord.enter < chord.leave)) return spans;
  spans.starts_inside = chord.enter == -infinity;
  if (!spans.starts_inside) spans.crossings.push_back({.t = chord.enter, .gradient = chord.enter_gradient});
  if (chord.leave != infinity)
    spans.crossings.push_back({.t = chord.leave, .gradient = chord.leave_gradient});
  return spans;
}

Spans spans_of_solid(const Mesh&, const Ray&) {
  throw std::invalid_argument("the reference tracer has no meshes");
}
Spans spans_of_solid(const Bezier&, const Ray&) {
  throw std::invalid_argument("the reference tracer has no Bezier surfaces");
}
Spans spans_of_solid(const Torus& torus, const Ray& ray) { return spans_of_torus(torus, ray); }

// x^2 + y^2 - z^2 < 0 between the roots, or before the first and after the last.
Spans spans_of_solid(const Cone& cone, const Ray& ray) {
  const Vec metric(1, 1, -1);
  const Vec o = ray.origin, d = ray.direction;
  const Real a = glm::dot(d * metric, d), b = glm::dot(o * metric, d), c = glm::dot(o * metric, o);
  const Vec m = glm::cross(o, d);
  const Real rest = glm::dot(m * metric, m);  // b^2 - a c
  if (rest <= 0 || a == 0) return {};
  const Real root = std::sqrt(rest), q = -(b + std::copysign(root, b));
  const Real first = std::min(c / q, q / a), last = std::max(c / q, q / a);
  const auto gradient = [&](Real t) { return metric * (o + t * d); };

  std::vector<Chord> nappes(1);
  nappes[0].clip(first, gradient(first), last, gradient(last));
  if (a < 0) {
    nappes.assign(2, {});
    nappes[0].clip(-infinity, Vec(0), first, gradient(first));
    nappes[1].clip(last, gradient(last), infinity, Vec(0));
  }
  Spans spans;
  for (Chord& nappe : nappes) {
    clip_half_space(nappe, ray, Vec(0, 0, -1), -Real(cone.z_min));
    clip_half_space(nappe, ray, Vec(0, 0, 1), cone.z_max);
    const Spans part = spans_of_chord(nappe);
    spans.starts_inside = spans.starts_inside || part.starts_inside;
    spans.crossings.insert(spans.crossings.end(), part.crossings.begin(), part.crossings.end());
  }
  return spans;
}

template <class Convex>
Spans spans_of_solid(const Convex& solid, const Ray& ray) {
  return spans_of_chord(chord_of(solid, ray));
}

Real size_of(const Vec& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

}  // namespace

Spans spans_of(const Leaf& leaf, int number, const Ray& ray, const Rules& rules) {
  const Ray local{leaf.local_from_world * (ray.origin - leaf.offset), leaf.local_from_world * ray.direction};
  Spans spans = rules.spans(leaf.solid, local);
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

Spans spans_of(const Solid& solid, const Ray& local) {
  return std::visit([&](const auto& s) { return spans_of_solid(s, local); }, solid);
}

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
