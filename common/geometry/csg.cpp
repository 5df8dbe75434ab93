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

/// The event to show of a group [first, next) that changed the side of the whole object.
std::size_t shown_event(std::span<const CsgItem> items, const CsgWorkspace& ws, std::size_t first) {
  const std::uint32_t item = shown_leaf(items, ws, 0);
  while (ws.events[first].item != item) ++first;
  return first;
}

/// Toggles the leaves of all events that overlap number `next`, the object's counts before them kept in
/// counts_before if they are several. Returns the first event's number; `next` goes on behind them.
std::size_t pass_group(std::span<const CsgItem> items, CsgWorkspace& ws, std::size_t& next) {
  const std::size_t first = next++;
  double hi = ws.events[first].hi;
  while (next < ws.events.size() && ws.events[next].lo <= hi) hi = greatest(hi, ws.events[next++].hi);
  if (next - first > 1) ws.counts_before = ws.counts;
  for (std::size_t e = first; e < next; ++e) toggle(items, ws.counts, ws.events[e].item);
  return first;
}

}  // namespace

template bool gather(std::span<const CsgItem>, std::span<const Leaf>, const RayQuery&, double, CsgWorkspace&);

bool next_boundary(std::span<const CsgItem> items, CsgWorkspace& ws, std::size_t& next, Boundary& found) {
  const auto inside = [&] { return is_inside(items[0], ws.counts[0]); };
  while (next < ws.events.size()) {
    const bool before = inside();
    const std::size_t first = pass_group(items, ws, next);
    if (inside() == before) continue;
    const CsgWorkspace::Event& e = ws.events[next - first == 1 ? first : shown_event(items, ws, first)];
    found = {e.t,     e.error,        items[e.item].leaf, ws.counts[e.item] != 0,
             !before, unknown_medium, unknown_medium,     e.part};
    return true;
  }
  return false;
}

std::uint32_t filling_item(std::span<const CsgItem> items, const CsgWorkspace& ws) {
  const auto holds = [&](std::uint32_t item) { return is_inside(items[item], ws.counts[item]); };
  if (!holds(0)) return no_leaf;
  std::uint32_t filling = 0;
  while (items[filling].leaf == no_leaf) {
    const CsgItem& node = items[filling];
    std::uint32_t child = ++filling;  // of a difference
    for (std::uint32_t i = 0; node.op != CsgOp::subtract && i < node.children; ++i, child = items[child].next)
      if (holds(child)) filling = child;
  }
  return filling;
}

bool next_filling(std::span<const CsgItem> items, CsgWorkspace& ws, std::size_t& next,
                  FillingChange& change) {
  while (next < ws.events.size()) {
    change.before = filling_item(items, ws);
    const std::size_t first = pass_group(items, ws, next);
    change.after = filling_item(items, ws);
    if (change.before == change.after) continue;
    std::size_t shown = first;
    if (next - first > 1 && (change.before == no_leaf || change.after == no_leaf)) {
      shown = shown_event(items, ws, first);
    } else {
      for (std::size_t e = first; e < next; ++e)
        if (ws.events[e].item == change.after || ws.events[e].item == change.before) shown = e;
    }
    const CsgWorkspace::Event& e = ws.events[shown];
    change.found = {e.t,   e.error,        items[e.item].leaf, ws.counts[e.item] != 0,
                    false, unknown_medium, unknown_medium,     e.part};
    return true;
  }
  return false;
}

}  // namespace rayfarm
