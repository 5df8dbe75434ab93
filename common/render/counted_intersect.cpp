// Intersection that counts its work.
#include "common/geometry/gather.h"
#include "common/render/intersect.h"
#include "common/render/nested_media.h"

namespace rayfarm {

template std::optional<Boundary> first_boundary(const World::Parts&, const RayQuery&, CountingWorkspace&);
template std::optional<Boundary> first_change_of_medium(const World::Parts&, const RayQuery&,
                                                        CountingWorkspace&);
template bool is_blocked(const World::Parts&, const RayQuery&, CountingWorkspace&);

}  // namespace rayfarm
