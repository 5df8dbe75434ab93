// Rays in a scene with nested media: a boundary is wherever another material begins, also inside a solid.
//
// What fills a place is computed from the spans of all solids along the ray, not tracked from hit to hit, so it
// holds for a camera inside a solid and after any number of refractions. Where several solids overlap, the one
// written last in the scene fills the place. Of the two sides of a boundary, the inner one is that whose solid
// was written later; empty space is always the outer one. Source of the idea of priorities: C. M. Schmidt and B.
// Budge, Simple Nested Dielectrics in Ray Traced Images, JGT 7(2), 2002.
//
// For the files that instantiate it, after intersect.h.
#pragma once
#include "common/render/intersect.h"

namespace rayfarm {
namespace {

/// By which leaf the scene is filled: the last of those that fill the objects which the ray is in.
class Filling {
 public:
  explicit Filling(std::vector<std::uint32_t>& leaves) : leaves_(leaves) { leaves_.clear(); }

  void put(std::uint32_t leaf) {
    if (leaf != no_leaf) leaves_.push_back(leaf);
  }
  void change(std::uint32_t before, std::uint32_t after) {
    if (before != no_leaf) std::erase(leaves_, before);
    put(after);
  }
  /// None in empty space.
  std::optional<std::uint32_t> leaf() const {
    if (leaves_.empty()) return std::nullopt;
    return *std::ranges::max_element(leaves_);
  }

 private:
  std::vector<std::uint32_t>& leaves_;  // in preorder of the scene: the higher, the later
};

/// The changes of all objects' fillings ahead of the ray into ws.events, in order, and what fills its start.
template <class Csg>
Filling gather_fillings(const World::Parts& w, const RayQuery& q, WorkspaceWith<Csg>& ws) {
  ws.events.clear();
  Filling filling(ws.filling);
  visit_objects(w, q, infinity, ws, [&](const ObjectRef& ref) {
    const std::span<const CsgItem> items = w.items_of(w.objects[ref.object]);
    const auto leaf_of = [&](std::uint32_t item) { return item == no_leaf ? no_leaf : items[item].leaf; };
    gather(items, w.leaves, q, infinity, ws.csg);
    filling.put(leaf_of(filling_item(items, ws.csg)));
    FillingChange change;
    for (std::size_t next = 0; next_filling(items, ws.csg, next, change);) {
      Boundary b = change.found;
      b.outer = leaf_of(change.before), b.inner = leaf_of(change.after);  // leaves, in the order of the ray
      ws.events.push_back({b.t - b.error, b.t + b.error, ref.object, b});
    }
    return true;
  });
  std::sort(ws.events.begin(), ws.events.end(),
            [](const auto& a, const auto& b) { return a.lo != b.lo ? a.lo < b.lo : a.object < b.object; });
  return filling;
}

std::uint32_t medium_of(const World::Parts& w, std::optional<std::uint32_t> leaf) {
  return leaf ? w.surfaces[*leaf].material : empty_space;
}

}  // namespace

template <class Csg>
std::optional<Boundary> first_change_of_medium(const World::Parts& w, const RayQuery& q,
                                               WorkspaceWith<Csg>& ws) {
  Filling filling = gather_fillings(w, q, ws);
  for (std::size_t next = 0; next < ws.events.size();) {
    const std::optional<std::uint32_t> before = filling.leaf();
    const std::size_t first = next;
    for (double hi = ws.events[first].hi; next < ws.events.size() && ws.events[next].lo <= hi; ++next) {
      hi = greatest(hi, ws.events[next].hi);
      filling.change(ws.events[next].boundary.outer, ws.events[next].boundary.inner);
    }
    const std::optional<std::uint32_t> after = filling.leaf();
    if (medium_of(w, before) == medium_of(w, after)) continue;
    const bool entering = after > before;  // an empty optional is the least
    const std::uint32_t inner_leaf = entering ? *after : *before;
    // The inner side's own object has changed; its event is shown.
    std::size_t shown = first;
    while ((entering ? ws.events[shown].boundary.inner : ws.events[shown].boundary.outer) != inner_leaf)
      ++shown;
    Boundary b = ws.events[shown].boundary;
    b.entering = entering;
    b.inner = medium_of(w, inner_leaf), b.outer = medium_of(w, entering ? before : after);
    return b;
  }
  return std::nullopt;
}

}  // namespace rayfarm
