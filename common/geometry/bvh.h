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
  /// Over boxes that are bounded and not empty.
  explicit Bvh(std::span<const Box> boxes);

  /// The numbers of the boxes in the order of the tree's leaves: who lays the contents out like this finds
  /// them side by side.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// Calls visit(place) for each box that the ray meets before t_max, roughly near to far; place is the
  /// position in order(). The visitor may lower t_max, and ends the walk by returning false. Its box_tested(),
  /// if it has one, is called for each box on the way. The line is a RayQuery or a WideLine.
  template <class Line, class Visit>
  void visit(const Line& line, const double& t_max, Visit&& visit_box) const;

 private:
  /// What stands below a node: boxes first .. first + count of order_, or for count 0 the node `first`.
  struct Child {
    Box box = nowhere();
    std::uint32_t first = 0, count = 0;
  };
  struct Node {
    Child child[2];
  };
  static constexpr int max_depth = 64;

  Child build(std::uint32_t first, std::uint32_t last, int depth, std::span<const Box> boxes);

  Child root_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

template <class Line, class Visit>
void Bvh::visit(const Line& line, const double& t_max, Visit&& visit_box) const {
  const auto test = [&](const Box& box) {
    if constexpr (requires { visit_box.box_tested(); }) visit_box.box_tested();
    return span_in(box, line, t_max);
  };
  struct Waiting {
    const Child* child;
    double entry;
  };
  Waiting stack[max_depth];
  int waiting = 0;
  const BoxSpan whole = test(root_.box);
  if (whole.entry > whole.exit || order_.empty()) return;  // a ray of NaN meets all boxes, also none
  const Child* next = &root_;
  while (next) {
    const Child* nearest = nullptr;
    if (next->count > 0) {
      for (std::uint32_t place = next->first; place < next->first + next->count; ++place)
        if (!visit_box(place)) return;
    } else {
      const Node& node = nodes_[next->first];
      const BoxSpan a = test(node.child[0].box), b = test(node.child[1].box);
      const bool meets_a = a.entry <= a.exit, meets_b = b.entry <= b.exit;
      if (meets_a && meets_b) {
        const bool a_first = a.entry <= b.entry;
        nearest = &node.child[a_first ? 0 : 1];
        stack[waiting++] = {&node.child[a_first ? 1 : 0], a_first ? b.entry : a.entry};
      } else if (meets_a || meets_b) {
        nearest = &node.child[meets_a ? 0 : 1];
      }
    }
    while (!nearest && waiting > 0)
      if (const Waiting& last = stack[--waiting]; last.entry <= t_max) nearest = last.child;
    next = nearest;
  }
}

}  // namespace rayfarm
