// Rays against the union of all objects.
//
// A ray that starts outside everything meets the union's surface where it first enters an object. One that
// starts inside an object (refraction, a camera in glass) follows the union until it has left all of them.
//
// In a scene with nested media, nested_media.h does it.
//
// For the files that instantiate it: one for each workspace, so that the one that counts nothing is compiled as if
// there were no other.
#pragma once
#include <algorithm>
#include <type_traits>

#include "common/render/world_parts.h"

namespace rayfarm {
namespace {

ObjectStart starting(bool inside, const Bounded<double>& at, std::uint32_t leaf) {
  const Crossing c = crossing_at(at);
  return {inside, at.t < infinity, {c.t, c.error, leaf, !inside, !inside}};
}

/// A convex leaf alone: what is ahead of its interval, without a list.
ObjectStart start_of_interval(const Interval<double>& i, std::uint32_t leaf) {
  if (i.enter.lo > i.leave.hi || i.leave.lo <= 0) return {};
  if (i.enter.lo <= 0) return starting(true, i.leave, leaf);
  if (i.leave.lo <= i.enter.hi && !i.is_certain) return {};  // in and out within the error: without effect
  return starting(false, i.enter, leaf);
}

/// Crossings that overlap are one event; an even number of them changes nothing.
ObjectStart start_of_crossings(const Crossings& c, std::uint32_t leaf) {
  const auto at = [&](int i) -> const Crossing& { return c.at[static_cast<std::size_t>(i)]; };
  for (int i = 0, last = 0; i < c.count; i = last) {
    double hi = at(i).hi();
    for (last = i + 1; last < c.count && at(last).lo() <= hi; ++last) hi = greatest(hi, at(last).hi());
    if ((last - i) % 2 == 1) return starting(c.starts_inside, {at(i).t, at(i).lo(), at(i).hi()}, leaf);
  }
  return {c.starts_inside, false, {}};
}

ObjectStart start_of_leaf(const Leaf& leaf, std::uint32_t number, const RayQuery& q) {
  if (!is_left(leaf, q))
    if (const auto interval = convex_interval(leaf, q)) return start_of_interval(*interval, number);
  return start_of_crossings(crossings_ahead(leaf, q), number);
}

template <class Csg>
ObjectStart start_of_tree(Closely, std::span<const CsgItem> items, const World::Parts& w, const RayQuery& q,
                          double t_max, Csg& ws) {
  ObjectStart start;
  start.inside = gather(items, w.leaves, q, t_max, ws);
  std::size_t next = 0;
  start.has_boundary = next_boundary(items, ws, next, start.first);
  return start;
}
inline ObjectStart start_of_tree(AtAGlance, std::span<const CsgItem> items, const World::Parts& w,
                                 const RayQuery& q, double t_max, CsgWorkspace& ws) {
  return start_at_a_glance(items, w.leaves, q, t_max, ws);
}

/// That of a leaf with facets, which the ray passes in one of its parts.
Boundary boundary_at(const FacetCrossing& c, std::uint32_t leaf, bool entering) {
  Boundary boundary{c.t, c.error, leaf, entering, entering};
  boundary.part = c.part;
  return boundary;
}

/// A leaf with facets alone: mostly the nearest crossing tells all.
template <class Csg>
ObjectStart start_of_facets(const Leaf& leaf, std::uint32_t number, const RayQuery& q, double t_max,
                            Csg& ws) {
  const LocalRay<double> local = to_local(leaf, q);
  const Departure from = departure_from(leaf, q);
  Nearest nearest = nearest_crossing(*leaf.facets, local, from, t_max);
  // Inside there is a crossing ahead, however far; it tells the side.
  if (!nearest.crossing && nearest.is_sure && may_start_inside(*leaf.facets, local, from))
    nearest = nearest_crossing(*leaf.facets, local, from, infinity);
  if (nearest.is_sure) {
    if (!nearest.crossing) return {};
    const bool entering = nearest.crossing->entering;
    return {!entering && !leaf.is_sheet(), true, boundary_at(*nearest.crossing, number, entering)};
  }
  find_path_ahead(leaf, q, ws.path);
  const bool inside = ws.path.starts_inside;
  const std::vector<FacetCrossing>& at = ws.path.crossings;
  for (std::size_t i = 0, last = 0; i < at.size(); i = last) {
    double hi = at[i].hi();
    for (last = i + 1; last < at.size() && at[last].lo() <= hi; ++last) hi = greatest(hi, at[last].hi());
    if ((last - i) % 2 == 1) return {inside, true, boundary_at(at[i], number, !inside)};
  }
  return {inside, false, {}};
}

template <class Look, class Csg>
ObjectStart start_of(Look look, const World::Parts& w, const ObjectRef& ref, const RayQuery& q, double t_max,
                     WorkspaceWith<Csg>& ws) {
  if constexpr (Csg::counts_tests)
    if (ref.leaf != no_leaf) ws.csg.leaf_tested(crossings_ahead(w.leaves[ref.leaf], q));
  if (ref.leaf != no_leaf) return start_of_leaf(w.leaves[ref.leaf], ref.leaf, q);
  if (ref.facets != no_leaf) return start_of_facets(w.leaves[ref.facets], ref.facets, q, t_max, ws.csg);
  return start_of_tree(look, w.items_of(w.objects[ref.object]), w, q, t_max, ws.csg);
}

/// A visitor that counts the boxes on its way.
template <class Visit>
struct CountingVisit {
  Visit visit;
  RayTests& tests;
  bool operator()(std::uint32_t place) { return visit(place); }
  void box_tested() { ++tests.boxes; }
};
template <class Visit>
CountingVisit(Visit, RayTests&) -> CountingVisit<Visit>;

template <class Csg, class Visit>
void visit_objects(const World::Parts& w, const RayQuery& q, const double& t_max, WorkspaceWith<Csg>& ws,
                   Visit&& visit) {
  for (const ObjectRef& ref : w.endless_objects)
    if (!visit(ref)) return;
  const auto visit_place = [&](std::uint32_t place) { return visit(w.bounded_objects[place]); };
  if constexpr (Csg::counts_tests)
    w.bvh.visit(q, t_max, CountingVisit{visit_place, ws.csg.tests});
  else
    w.bvh.visit(q, t_max, visit_place);
}

/// The boundaries of all objects, in order. Returns how many objects the ray starts in.
template <class Csg>
std::ptrdiff_t gather_union(const World::Parts& w, const RayQuery& q, WorkspaceWith<Csg>& ws) {
  ws.events.clear();
  std::ptrdiff_t inside = 0;
  visit_objects(w, q, infinity, ws, [&](const ObjectRef& ref) {
    const std::span<const CsgItem> items = w.items_of(w.objects[ref.object]);
    inside += gather(items, w.leaves, q, infinity, ws.csg);
    Boundary b;
    for (std::size_t next = 0; next_boundary(items, ws.csg, next, b);)
      if (const double lo = b.t - b.error, hi = b.t + b.error;
          lo <= hi)  // else so far away that nobody knows where
        ws.events.push_back({lo, hi, ref.object, b});
    return true;
  });
  std::sort(ws.events.begin(), ws.events.end(),
            [](const auto& a, const auto& b) { return a.lo != b.lo ? a.lo < b.lo : a.object < b.object; });
  return inside;
}

template <class Csg>
std::optional<Boundary> first_of_union(const World::Parts& w, const RayQuery& q, WorkspaceWith<Csg>& ws) {
  std::ptrdiff_t inside = gather_union(w, q, ws);
  for (std::size_t next = 0; next < ws.events.size();) {
    const bool before = inside > 0;
    const std::size_t first = next;
    double hi = ws.events[first].hi;
    std::size_t shown = first;
    for (; next < ws.events.size() && ws.events[next].lo <= hi; ++next) {
      const auto& e = ws.events[next];
      hi = greatest(hi, e.hi);
      inside += e.boundary.entering ? 1 : -1;
      if (e.boundary.entering != before &&
          (ws.events[shown].boundary.entering == before || e.object < ws.events[shown].object))
        shown = next;
    }
    if ((inside > 0) != before) return ws.events[shown].boundary;
  }
  return std::nullopt;
}

/// The object's first boundary at t <= 1 that casts a shadow.
template <class Csg>
std::optional<Boundary> blocker_in(const World::Parts& w, const ObjectRef& ref, const RayQuery& q,
                                   WorkspaceWith<Csg>& ws) {
  if (ref.facets != no_leaf) {  // all of it casts shadows, or none
    const ObjectStart start = start_of(Closely{}, w, ref, q, 1.0, ws);
    if (!start.has_boundary || start.first.t > 1 || !w.surfaces[ref.facets].casts_shadow) return std::nullopt;
    return start.first;
  }
  const std::span<const CsgItem> items = w.items_of(w.objects[ref.object]);
  gather(items, w.leaves, q, 1.0, ws.csg);
  Boundary b;
  for (std::size_t next = 0; next_boundary(items, ws.csg, next, b) && b.t <= 1;)
    if (w.surfaces[b.leaf].casts_shadow) return b;
  return std::nullopt;
}

/// Who counts tests has them made closely.
template <class Csg>
using FirstLook = std::conditional_t<Csg::counts_tests, Closely, AtAGlance>;

/// The first of all objects' first boundaries, as far as they are known.
template <class Look>
struct FirstOfObjects {
  bool starts_inside = false;  // an object; nothing else is known then
  bool is_unsure = false;      // two that seem near want to be looked at closely
  double t_max = infinity;     // the found one's far end
  std::uint32_t object = 0;
  std::optional<Boundary> boundary;

  /// Whether the search goes on.
  [[gnu::always_inline]] bool offer(const Boundary& b, std::uint32_t of_object) {
    if (b.t - b.error > t_max) return true;
    // Surfaces within each other's error are one; the object that comes first in the scene is shown.
    const bool same = boundary && boundary->t - boundary->error <= b.t + b.error;
    if (std::is_same_v<Look, AtAGlance> && same) {
      is_unsure = true;
      return false;
    }
    if (same && object < of_object) return true;
    boundary = b, object = of_object;
    t_max = b.t + b.error;
    return true;
  }
};

template <class Look, class Csg>
void find_first(FirstOfObjects<Look>& first, const World::Parts& w, const RayQuery& q,
                WorkspaceWith<Csg>& ws) {
  visit_objects(w, q, first.t_max, ws, [&](const ObjectRef& ref) {
    if constexpr (std::is_same_v<Look, AtAGlance>)
      if (ref.leaf != no_leaf) {
        const Glance g = glance_ahead(w.leaves[ref.leaf], q);
        if (g.verdict == Glance::Verdict::misses) return true;
        if (g.verdict == Glance::Verdict::passes) {
          first.starts_inside = g.enter < 0;
          return !first.starts_inside && first.offer({g.enter, g.blur, ref.leaf, true, true}, ref.object);
        }
      }
    const ObjectStart start = start_of(Look{}, w, ref, q, first.t_max, ws);
    first.starts_inside = start.inside;
    if (start.inside || !start.has_boundary) return !start.inside;
    return first.offer(start.first, ref.object);
  });
}

}  // namespace

template <class Csg>
std::optional<Boundary> first_boundary(const World::Parts& w, const RayQuery& q, WorkspaceWith<Csg>& ws) {
  if (w.scene.nested_media) return first_change_of_medium(w, q, ws);
  if (!w.asks_for_errors()) {
    FirstOfObjects<FirstLook<Csg>> first;
    find_first(first, w, q, ws);
    if (!first.is_unsure && !first.starts_inside) return first.boundary;
    if (first.starts_inside) return first_of_union(w, q, ws);
  }
  FirstOfObjects<Closely> first;
  find_first(first, w, q, ws);
  return first.starts_inside ? first_of_union(w, q, ws) : first.boundary;
}

template <class Csg>
bool is_blocked(const World::Parts& w, const RayQuery& q, WorkspaceWith<Csg>& ws) {
  bool blocked = false;
  visit_objects(w, q, 1.0, ws, [&](const ObjectRef& ref) {
    if constexpr (!Csg::counts_tests)
      if (ref.leaf != no_leaf && w.all_cast_shadows) {
        const Glance g = glance_ahead(w.leaves[ref.leaf], q);
        if (g.verdict == Glance::Verdict::misses) return true;
        if (g.verdict == Glance::Verdict::passes) return !(blocked = (g.enter < 0 ? g.leave : g.enter) <= 1);
      }
    const ObjectStart start = start_of(FirstLook<Csg>{}, w, ref, q, 1.0, ws);
    blocked = start.has_boundary && start.first.t <= 1;
    if (blocked && !w.all_cast_shadows) blocked = blocker_in(w, ref, q, ws).has_value();
    return !blocked;
  });
  return blocked;
}

}  // namespace rayfarm
