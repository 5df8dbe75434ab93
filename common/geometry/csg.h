// A CSG object along a ray: all leaves' crossings merged at once, the tree's value followed from one to the
// next.
//
// Crossings whose error intervals overlap are one event: all their leaves change sides together, and a
// boundary is there only if the object's value is another one after it than before. So coincident faces leave
// no skin, tangent pairs no speck. Source: S. D. Roth, Ray Casting for Modeling Solids, CGIP 18(2), 1982; the
// merge of n lists at once and the error intervals after Requicha and Voelcker (see crossing.h).
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/bounds.h"
#include "common/geometry/leaf.h"
#include "common/geometry/solid.h"

namespace rayfarm {

/// A node of an object's tree, in preorder. Item numbers count from the object's first item.
struct CsgItem {
  Box box;                   // where it can matter: its own bounds cut by those of what it is combined with
  std::uint32_t next = 0;    // the item after this subtree
  std::uint32_t parent = 0;  // of the root: itself
  std::uint32_t leaf = no_leaf;  // of an inner node: none
  std::uint32_t children = 0;
  CsgOp op = CsgOp::unite;
  std::int32_t weight = 1;  // what it adds to its parent's count when inside; 2 for what is subtracted
  // Of a leaf that is there more than once: the first item of the same surface.
  std::uint32_t first_twin = no_leaf;
};

/// Where the ray passes the surface of an object (or of the whole scene).
struct Boundary {
  double t, error;
  std::uint32_t leaf;
  bool leaf_entering;  // the ray goes into the leaf
  bool entering;       // the ray goes into the material
  std::uint32_t inner = unknown_medium,
                outer = unknown_medium;  // the material's side and the other: nested media
  std::uint32_t part = no_part;          // of the leaf: the triangle or patch, where there are such
};

/// Memory for one thread's rays, reused from ray to ray.
struct CsgWorkspace {
  static constexpr bool counts_tests = false;
  struct Event {
    double t, error;
    std::uint32_t item, part;
    double lo() const { return t - error; }
    double hi() const { return t + error; }
  };
  std::vector<std::int32_t> counts;         // per item: how much of it is inside
  std::vector<std::int32_t> counts_before;  // before a boundary that several leaves make
  std::vector<Event> events;
  FacetPath path;

  /// What the ray meets of a leaf that is there more than once, looked at once.
  struct Seen {
    std::uint64_t gathering = 0;  // which one it was seen in
    Glance glance;
    std::optional<Crossings> crossings;
  };
  std::vector<Seen> seen;  // per item, as far as needed
  std::uint64_t gathering = 0;
};

/// What it takes to find out what rays meet.
struct RayTests {
  std::uint64_t boxes = 0;      // of the hierarchy and of CSG nodes, tested
  std::uint64_t leaves = 0;     // solids tested
  std::uint64_t crossings = 0;  // of solids' surfaces found, ahead of the ray
  bool operator==(const RayTests&) const = default;
  RayTests& operator+=(const RayTests& o) {
    boxes += o.boxes, leaves += o.leaves, crossings += o.crossings;
    return *this;
  }
};

/// For who counts: nobody else pays.
struct CountingCsgWorkspace : CsgWorkspace {
  static constexpr bool counts_tests = true;
  RayTests tests;

  void leaf_tested(const Crossings& found) {
    ++tests.leaves, tests.crossings += static_cast<std::uint64_t>(found.count);
  }
  void path_tested() { ++tests.leaves, tests.crossings += path.crossings.size(); }
};

/// Whether an item with that count is inside. A leaf counts 0 or 1.
inline bool is_inside(const CsgItem& item, std::int32_t count) {
  if (item.leaf != no_leaf) return count != 0;
  switch (item.op) {
    case CsgOp::unite:
      return count > 0;
    case CsgOp::intersect:
      return count == static_cast<std::int32_t>(item.children);
    case CsgOp::subtract:
      return count == 1;  // the first child and none of the others
    case CsgOp::exclusive_or:
      return (count & 1) != 0;
  }
  return false;
}

/// How leaves are looked at: for crossings with their bounds, or at a glance where that tells enough.
struct Closely {};
struct AtAGlance {};

/// Finds the crossings of all leaves ahead of the ray into workspace.events (by lo), and every item's side at
/// the origin into workspace.counts. Returns the object's side there.
template <class Workspace>  // a CsgWorkspace
bool gather(std::span<const CsgItem> items, std::span<const Leaf> leaves, const RayQuery& ray, double t_max,
            Workspace& workspace);

/// An object's side at the ray's origin and its first boundary, if any.
struct ObjectStart {
  bool inside = false;
  bool has_boundary = false;
  Boundary first;
};

/// What gather() and next_boundary() find first, its leaves seen at a glance where that can do: to the bit the same but
/// for the boundary's error, which may be larger.
ObjectStart start_at_a_glance(std::span<const CsgItem> items, std::span<const Leaf> leaves,
                              const RayQuery& ray, double t_max, CsgWorkspace& workspace);

/// Goes on to the next boundary of a gathered object, from event number `next` on; false when there is none
/// left.
bool next_boundary(std::span<const CsgItem> items, CsgWorkspace& workspace, std::size_t& next,
                   Boundary& found);

/// The item of the leaf that fills the object where the workspace's counts stand: of a difference one of its
/// first part, else the last one in the tree that holds the place. None outside.
std::uint32_t filling_item(std::span<const CsgItem> items, const CsgWorkspace& workspace);

/// Goes on to the next change of what fills a gathered object, which changes from `before` to `after` (items,
/// or no_leaf outside). Of `found`, entering is not set.
struct FillingChange {
  Boundary found;
  std::uint32_t before, after;
};
bool next_filling(std::span<const CsgItem> items, CsgWorkspace& workspace, std::size_t& next,
                  FillingChange& change);

/// Whether the ray starts on the leaf's surface.
inline bool is_left(const Leaf& leaf, const RayQuery& q) { return leaf.surface == q.ray.left_surface; }

/// A leaf at a glance, also when the ray starts on it: a convex one that it leaves outward is not met again.
[[gnu::always_inline]] inline Glance glance_ahead(const Leaf& leaf, const RayQuery& q) {
  if (!is_left(leaf, q)) return glance(leaf, q);
  if (q.ray.into_leaf) return exit_at_a_glance(leaf, q);
  return is_convex(leaf.solid) ? Glance::missing() : Glance{};
}

/// The crossings of one leaf ahead of the ray, also when the ray starts on it.
inline Crossings crossings_ahead(const Leaf& leaf, const RayQuery& q) {
  if (is_left(leaf, q)) return crossings_from_surface(leaf, to_local(leaf, q), q.ray.into_leaf);
  return crossings(leaf, q);
}

/// What a leaf with facets must know of the ray's start.
inline Departure departure_from(const Leaf& leaf, const RayQuery& q) {
  if (!is_left(leaf, q)) return {};
  return {q.ray.left_part, q.ray.into_leaf};
}

/// The same for a leaf with facets. A sheet has no inside, so it has none.
inline void find_path_ahead(const Leaf& leaf, const RayQuery& q, FacetPath& path) {
  path.starts_inside = false;
  path.crossings.clear();
  if (!leaf.is_sheet()) find_path(*leaf.facets, to_local(leaf, q), departure_from(leaf, q), path);
}

}  // namespace rayfarm
