#include "common/render/intersect.h"

#include "common/render/nested_media.h"

namespace rayfarm {

template std::optional<Boundary> first_boundary(const World::Parts&, const RayQuery&, WorldWorkspace&);
template std::optional<Boundary> first_change_of_medium(const World::Parts&, const RayQuery&,
                                                        WorldWorkspace&);
template bool is_blocked(const World::Parts&, const RayQuery&, WorldWorkspace&);

std::optional<Boundary> first_blocker(const World::Parts& w, const RayQuery& q, WorldWorkspace& ws) {
  std::optional<Boundary> first;
  visit_objects(w, q, 1.0, ws, [&](const ObjectRef& ref) {
    const std::optional<Boundary> b = blocker_in(w, ref, q, ws);
    if (b && (!first || b->t < first->t)) first = b;
    return true;
  });
  return first;
}

bool ends_inside(const World::Parts& w, const RayQuery& q, WorldWorkspace& ws) {
  return std::ranges::any_of(w.endless_objects, [&](const ObjectRef& ref) {
    const std::span<const CsgItem> items = w.items_of(w.objects[ref.object]);
    bool inside = gather(items, w.leaves, q, infinity, ws.csg);
    Boundary b;
    for (std::size_t next = 0; next_boundary(items, ws.csg, next, b);) inside = b.entering;
    return inside;
  });
}

}  // namespace rayfarm
