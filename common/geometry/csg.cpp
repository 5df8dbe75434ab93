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

/// Toggles the leaves of a group.
void pass_group(std::span<const CsgItem> items, std::vector<std::int32_t>& counts,
                std::span<const CsgWorkspace::Event> group) {
  for (const CsgWorkspace::Event& event : group) toggle(items, counts, event.item);
}

/// The event to show of a group that has changed the side of the whole object.
const CsgWorkspace::Event& shown_event(std::span<const CsgItem> items, CsgWorkspace& ws,
                                       std::span<const CsgWorkspace::Event> group) {
  ws.counts_before = ws.counts;
  pass_group(items, ws.counts_before, group);  // a second time takes it back
  const std::uint32_t item = shown_leaf(items, ws, 0);
  return *std::ranges::find(group, item, &CsgWorkspace::Event::item);
}

/// The number of the event behind those that overlap number `first`.
std::size_t end_of_group(const std::vector<CsgWorkspace::Event>& events, std::size_t first) {
  std::size_t next = first + 1;
  double hi = events[first].hi();
  while (next < events.size() && events[next].lo() <= hi) hi = greatest(hi, events[next++].hi());
  return next;
}

/// Passes the events first to next - 1 as one; whether the object has a boundary there.
bool passes_boundary(std::span<const CsgItem> items, CsgWorkspace& ws, std::size_t first, std::size_t next,
                     Boundary& found) {
  const std::span group(ws.events.data() + first, next - first);
  const bool before = is_inside(items[0], ws.counts[0]);
  pass_group(items, ws.counts, group);
  if (is_inside(items[0], ws.counts[0]) == before) return false;
  const CsgWorkspace::Event& e = group.size() == 1 ? group[0] : shown_event(items, ws, group);
  found = {e.t,     e.error,        items[e.item].leaf, ws.counts[e.item] != 0,
           !before, unknown_medium, unknown_medium,     e.part};
  return true;
}

}  // namespace

template bool gather(std::span<const CsgItem>, std::span<const Leaf>, const RayQuery&, double, CsgWorkspace&);

bool next_boundary(std::span<const CsgItem> items, CsgWorkspace& ws, std::size_t& next, Boundary& found) {
  while (next < ws.events.size()) {
    const std::size_t first = next;
    next = end_of_group(ws.events, first);
    if (passes_boundary(items, ws, first, next, found)) return true;
  }
  return false;
}

namespace {

/// Moves the earliest event from number `first` on, and those that overlap it, to its place, in order. Returns the
/// number of the event behind them.
std::size_t take_group(std::vector<CsgWorkspace::Event>& events, std::size_t first) {
  // Without a jump: which one it is nobody can predict.
  std::size_t earliest = first;
  double least_lo = events[first].lo();
  for (std::size_t i = first + 1; i < events.size(); ++i) {
    const double lo = events[i].lo();
    earliest = lo < least_lo ? i : earliest;
    least_lo = lo < least_lo ? lo : least_lo;
  }
  std::swap(events[first], events[earliest]);
  double hi = events[first].hi();
  std::size_t next = first + 1;
  for (std::size_t i = next; i < events.size(); ++i) {
    if (!(events[i].lo() <= hi)) continue;
    hi = greatest(hi, events[i].hi());
    std::swap(events[next++], events[i]);
    i = next - 1;  // what did not overlap may do so now
  }
  if (next - first == 2 && comes_before(events[first + 1], events[first]))
    std::swap(events[first], events[first + 1]);
  if (next - first > 2) std::sort(events.begin() + first, events.begin() + next, comes_before);
  return next;
}

/// Of events along a ray: what comes before `entry` is taken as passed, what comes after `exit` is left out. That
/// matters only if some of it overlaps what is kept.
class Window {
 public:
  Window(double entry, double exit) : entry_(entry), exit_(exit) {}

  void put(std::span<const CsgItem> items, CsgWorkspace& ws, const CsgWorkspace::Event& event) {
    const double lo = event.lo(), hi = event.hi();
    if (hi < entry_) {
      early_hi_ = greatest(early_hi_, hi);
      toggle(items, ws.counts, event.item);
    } else if (lo > exit_) {
      late_lo_ = least(late_lo_, lo);
    } else {
      lo_ = least(lo_, lo), hi_ = greatest(hi_, hi);
      ws.events.push_back(event);
    }
  }
  /// Events from number `first` on.
  void put_again(std::span<const CsgItem> items, CsgWorkspace& ws, std::size_t first) {
    const std::size_t count = ws.events.size();
    for (std::size_t i = first; i < count; ++i) put(items, ws, CsgWorkspace::Event(ws.events[i]));
    ws.events.erase(ws.events.begin() + static_cast<std::ptrdiff_t>(first),
                    ws.events.begin() + static_cast<std::ptrdiff_t>(count));
  }
  bool cuts_nothing() const { return early_hi_ < lo_ && hi_ < late_lo_; }

 private:
  double entry_, exit_;
  double early_hi_ = -infinity, lo_ = infinity, hi_ = -infinity, late_lo_ = infinity;
};

/// Of a leaf that is there more than once in an object: what is known of it, which is nothing before the first.
CsgWorkspace::Seen* seen_of(const CsgItem& item, CsgWorkspace& ws) {
  if (item.first_twin == no_leaf) return nullptr;
  if (ws.seen.size() <= item.first_twin) ws.seen.resize(item.first_twin + 1);
  return &ws.seen[item.first_twin];
}

void gather_leaf(std::span<const CsgItem> items, std::uint32_t item, std::span<const Leaf> leaves,
                 const RayQuery& q, CsgWorkspace::Seen* seen, CsgWorkspace& ws) {
  const Leaf& leaf = leaves[items[item].leaf];
  if (!seen || leaf.facets) return gather_leaf(items, item, leaves, q, ws);
  if (!seen->crossings) seen->crossings = crossings_ahead(leaf, q);
  put_crossings(items, item, *seen->crossings, ws);
}

/// What gather() finds within a window, at a glance where that can do, in no order.
void gather_in(Window& window, std::span<const CsgItem> items, std::span<const Leaf> leaves,
               const RayQuery& q, double t_max, CsgWorkspace& ws) {
  ws.counts.assign(items.size(), 0);
  ws.events.clear();
  ++ws.gathering;
  visit_leaves(items, q, t_max, ws, [&](std::uint32_t item) {
    CsgWorkspace::Seen* const seen = seen_of(items[item], ws);
    const bool is_known = seen && seen->gathering == ws.gathering;
    const Glance g = is_known ? seen->glance : glance_ahead(leaves[items[item].leaf], q);
    if (seen && !is_known) seen->gathering = ws.gathering, seen->glance = g, seen->crossings.reset();
    if (g.verdict == Glance::Verdict::misses) return;
    if (g.verdict == Glance::Verdict::unsure) {
      const std::size_t first = ws.events.size();
      gather_leaf(items, item, leaves, q, seen, ws);
      window.put_again(items, ws, first);
      return;
    }
    if (g.enter < 0)
      toggle(items, ws.counts, item);
    else
      window.put(items, ws, {g.enter, g.blur, item, no_part});
    window.put(items, ws, {g.leave, g.blur, item, no_part});
  });
}

/// The same: only what lies within the object's box, where its boundaries are, if that makes no difference.
void gather_in_box(std::span<const CsgItem> items, std::span<const Leaf> leaves, const RayQuery& q,
                   double t_max, CsgWorkspace& ws) {
  constexpr double farthest = std::numeric_limits<double>::max();
  const BoxSpan span = span_in(items[0].box, q, t_max);
  Window box(span.entry * (1 - 16 * unit_roundoff), least(span.exit * (1 + 16 * unit_roundoff), farthest));
  gather_in(box, items, leaves, q, t_max, ws);
  if (box.cuts_nothing()) return;
  Window whole(0, farthest);
  gather_in(whole, items, leaves, q, t_max, ws);
}

/// Gives a crossing seen at a glance the error that a close look states.
void state_error(std::span<const CsgItem> items, std::span<const Leaf> leaves, const RayQuery& q,
                 CsgWorkspace::Event& event) {
  if (event.part != no_part) return;
  const Crossings close = crossings_ahead(leaves[items[event.item].leaf], q);
  for (int i = 0; i < close.count; ++i)
    if (const Crossing& c = close.at[static_cast<std::size_t>(i)]; c.t == event.t) event.error = c.error;
}

/// Whether events that overlap change no more than their leaves, each of another node: then it is all the same which
/// of them come together.
bool pass_unnoticed(std::span<const CsgItem> items, CsgWorkspace& ws, std::size_t first, std::size_t next) {
  const auto parent_after = [&](std::uint32_t item) {
    const std::int32_t count = ws.counts[items[item].parent];
    return ws.counts[item] != 0 ? count - items[item].weight : count + items[item].weight;
  };
  for (std::size_t e = first; e < next; ++e) {
    const std::uint32_t item = ws.events[e].item, parent = items[item].parent;
    if (is_inside(items[parent], ws.counts[parent]) != is_inside(items[parent], parent_after(item)))
      return false;
    for (std::size_t other = first; other < e; ++other)
      if (items[ws.events[other].item].parent == parent) return false;
  }
  for (std::size_t e = first; e < next; ++e) toggle(items, ws.counts, ws.events[e].item);
  return true;
}

}  // namespace

ObjectStart start_at_a_glance(std::span<const CsgItem> items, std::span<const Leaf> leaves, const RayQuery& q,
                              double t_max, CsgWorkspace& ws) {
  gather_in_box(items, leaves, q, t_max, ws);
  ObjectStart start{is_inside(items[0], ws.counts[0]), false, {}};
  for (std::size_t first = 0, next = 0; first < ws.events.size(); first = next) {
    next = take_group(ws.events, first);
    // What has the same t overlaps whatever the errors.
    const auto is_apart = [&](const auto& event) { return event.t != ws.events[first].t; };
    const std::span group(ws.events.data() + first, next - first);
    if (std::ranges::any_of(group, is_apart)) {
      if (pass_unnoticed(items, ws, first, next)) continue;
      for (CsgWorkspace::Event& event : group) state_error(items, leaves, q, event);
      next = take_group(ws.events, first);
    }
    if (passes_boundary(items, ws, first, next, start.first)) {
      start.has_boundary = true;
      break;
    }
  }
  return start;
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
    const std::size_t first = next;
    next = end_of_group(ws.events, first);
    const std::span group(ws.events.data() + first, next - first);
    pass_group(items, ws.counts, group);
    change.after = filling_item(items, ws);
    if (change.before == change.after) continue;
    const CsgWorkspace::Event* shown = &group[0];
    if (group.size() > 1 && (change.before == no_leaf || change.after == no_leaf)) {
      shown = &shown_event(items, ws, group);
    } else {
      for (const CsgWorkspace::Event& event : group)
        if (event.item == change.after || event.item == change.before) shown = &event;
    }
    const CsgWorkspace::Event& e = *shown;
    change.found = {e.t,   e.error,        items[e.item].leaf, ws.counts[e.item] != 0,
                    false, unknown_medium, unknown_medium,     e.part};
    return true;
  }
  return false;
}

}  // namespace rayfarm
