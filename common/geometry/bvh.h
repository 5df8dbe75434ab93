// A bounding volume hierarchy over boxes: a binary tree built by the surface area heuristic.
// Source: I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, RT 2007 (binned SAH).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/bounds.h"

namespace rayfarm {

class Bvh {
 public:
  Bvh() = default;
  /// Over boxes that are bounded and not empty; what visit() gets are their numbers in `boxes`.
  explicit Bvh(std::span<const Box> boxes);

  /// Calls visit(number) for each box that the ray meets before t_max, roughly near to far. The visitor may
  /// lower t_max, and ends the walk by returning false.
  template <class Visit>
  void visit(const RayQuery& ray, const double& t_max, Visit&& visit_box) const;

 private:
  struct Node {
    Box box;
    std::uint32_t first = 0;  // of its boxes in order_, or of its two children in nodes_
    std::uint32_t count = 0;  // of boxes; 0 for an inner node
  };
  static constexpr int max_depth = 64;

  void build(std::uint32_t node, std::uint32_t first, std::uint32_t last, int depth,
             std::span<const Box> boxes);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

template <class Visit>
void Bvh::visit(const RayQuery& ray, const double& t_max, Visit&& visit_box) const {
  if (nodes_.empty()) return;
  struct Waiting {
    std::uint32_t node;
    double entry;
  };
  Waiting stack[max_depth + 1];
  int waiting = 0;
  const BoxSpan whole = span_in(nodes_[0].box, ray, t_max);
  if (whole.entry > whole.exit) return;
  stack[waiting++] = {0, whole.entry};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.entry > t_max) continue;
    const Node& node = nodes_[next.node];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        if (!visit_box(order_[i])) return;
      continue;
    }
    const BoxSpan a = span_in(nodes_[node.first].box, ray, t_max);
    const BoxSpan b = span_in(nodes_[node.first + 1].box, ray, t_max);
    const bool meets_a = a.entry <= a.exit, meets_b = b.entry <= b.exit;
    const bool a_first = a.entry <= b.entry;  // the nearer is put on the stack last
    if (meets_b && a_first) stack[waiting++] = {node.first + 1, b.entry};
    if (meets_a) stack[waiting++] = {node.first, a.entry};
    if (meets_b && !a_first) stack[waiting++] = {node.first + 1, b.entry};
  }
}

}  // namespace rayfarm
