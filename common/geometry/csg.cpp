#include "common/geometry/gather.h"

namespace rayfarm {
namespace {

/// The leaf shown where several change sides at once: children are combined from left to right, and where
/// both sides of a combination change, the left one is shown.
std::uint32_t shown_leaf(std::span<const CsgItem> items, const CsgWorkspace& ws, std::uint32_t item) {
  const CsgItem& node = items[item];
  if (node.leaf != no_leaf) return item;
  const auto combined = [&](bool left, bool right) {
    switch (node.op) {
      case CsgOp::unite:
        return left || right;
      case CsgOp::intersect:
        return left && right;
      case CsgOp::subtract:
        return left && !right;
      case CsgOp::exclusive_or:
        return left != right;
    }
    return false;
  };
  std::uint32_t child = item + 1, shown = child;
  bool before = false, after = false;
  for (std::uint32_t i = 0; i < node.children; ++i, child = items[child].next) {
    const bool was = is_inside(items[child], ws.counts_before[child]);
    const bool is = is_inside(items[child], ws.counts[child]);
    const bool left_changed = i > 0 && before != after;
    before = i == 0 ? was : combined(before, was);
    after = i == 0 ? is : combined(after, is);
    if (!left_changed && was != is) shown = child;
  }
  return shown_leaf(items, ws, shown);
}

}  // namespace

template bool gather(std::span<const CsgItem>, std::span<const Leaf>, const RayQuery&, double, CsgWorkspace&);

bool next_boundary(std::span<const CsgItem> items, CsgWorkspace& ws, std::size_t& next, Boundary& found) {
  const auto inside = [&] { return is_inside(items[0], ws.counts[0]); };
  while (next < ws.events.size()) {
    const std::size_t first = next++;
    double hi = ws.events[first].hi;
    while (next < ws.events.size() && ws.events[next].lo <= hi) hi = greatest(hi, ws.events[next++].hi);

    const bool before = inside();
    std::size_t shown = first;
    if (next - first == 1) {
      toggle(items, ws.counts, ws.events[first].item);
      if (inside() == before) continue;
    } else {
      ws.counts_before = ws.counts;
      for (std::size_t e = first; e < next; ++e) toggle(items, ws.counts, ws.events[e].item);
      if (inside() == before) continue;
      const std::uint32_t item = shown_leaf(items, ws, 0);
      while (ws.events[shown].item != item) ++shown;
    }
    const CsgWorkspace::Event& e = ws.events[shown];
    found = {e.t, e.error, items[e.item].leaf, ws.counts[e.item] != 0, !before};
    return true;
  }
  return false;
}

}  // namespace rayfarm
