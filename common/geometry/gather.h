// How gather() works, for the files that instantiate it: one for each workspace, so that the one
// that counts nothing is compiled as if there were no other.
#pragma once
#include "common/geometry/csg.h"

namespace rayfarm {
namespace {

/// Changes the leaf's side and what follows from it upwards.
void toggle(std::span<const CsgItem> items, std::vector<std::int32_t>& counts, std::uint32_t item) {
  counts[item] ^= 1;
  bool inside = counts[item] != 0;
  while (item != items[item].parent) {
    const std::uint32_t parent = items[item].parent;
    const bool before = is_inside(items[parent], counts[parent]);
    counts[parent] += inside ? items[item].weight : -items[item].weight;
    inside = is_inside(items[parent], counts[parent]);
    if (inside == before) return;
    item = parent;
  }
}

/// A leaf with facets has any number of crossings.
template <class Workspace>
void gather_facets(std::span<const CsgItem> items, std::uint32_t item, const Leaf& leaf, const RayQuery& q,
                   Workspace& ws) {
  find_path_ahead(leaf, q, ws.path);
  if constexpr (Workspace::counts_tests) ws.path_tested();
  if (ws.path.starts_inside) toggle(items, ws.counts, item);
  for (const FacetCrossing& c : ws.path.crossings) ws.events.push_back({c.t, c.error, item, c.part});
}

/// A leaf's crossings into the events.
inline void put_crossings(std::span<const CsgItem> items, std::uint32_t item, const Crossings& found,
                          CsgWorkspace& ws) {
  if (found.starts_inside) toggle(items, ws.counts, item);
  for (int k = 0; k < found.count; ++k) {
    const Crossing& at = found.at[static_cast<std::size_t>(k)];
    ws.events.push_back({at.t, at.error, item, no_part});
  }
}

template <class Workspace>
void gather_leaf(std::span<const CsgItem> items, std::uint32_t item, std::span<const Leaf> leaves,
                 const RayQuery& q, Workspace& ws) {
  const Leaf& leaf = leaves[items[item].leaf];
  if (leaf.facets) return gather_facets(items, item, leaf, q, ws);
  const Crossings found = crossings_ahead(leaf, q);
  if constexpr (Workspace::counts_tests) ws.leaf_tested(found);
  put_crossings(items, item, found, ws);
}

/// Their order along the ray.
inline bool comes_before(const CsgWorkspace::Event& a, const CsgWorkspace::Event& b) {
  return a.lo() != b.lo() ? a.lo() < b.lo() : a.item < b.item;
}

/// Calls visit(item) for each leaf whose box the ray meets.
template <class Workspace, class Visit>
void visit_leaves(std::span<const CsgItem> items, const RayQuery& q, double t_max, Workspace& ws,
                  Visit&& visit) {
  for (std::uint32_t i = 0; i < items.size();) {
    const CsgItem& item = items[i];
    if constexpr (Workspace::counts_tests) ++ws.tests.boxes;
    const BoxSpan span = span_in(item.box, q, t_max);
    if (span.entry > span.exit) {
      i = item.next;
      continue;
    }
    if (item.leaf != no_leaf) visit(i);
    ++i;
  }
}

}  // namespace

template <class Workspace>
bool gather(std::span<const CsgItem> items, std::span<const Leaf> leaves, const RayQuery& q, double t_max,
            Workspace& ws) {
  ws.counts.assign(items.size(), 0);
  ws.events.clear();
  visit_leaves(items, q, t_max, ws, [&](std::uint32_t item) { gather_leaf(items, item, leaves, q, ws); });
  std::sort(ws.events.begin(), ws.events.end(), comes_before);
  return is_inside(items[0], ws.counts[0]);
}

}  // namespace rayfarm
