#include "common/render/intersect.h"

namespace rayfarm {

template std::optional<Boundary> first_boundary(const World::Parts&, const RayQuery&, WorldWorkspace&);
template bool is_blocked(const World::Parts&, const RayQuery&, WorldWorkspace&);

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
