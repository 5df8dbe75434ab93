#include "common/render/hit.h"

#include <cmath>

namespace rayfarm {
namespace {

bool is_odd(double whole) { return whole - 2 * std::floor(whole / 2) == 1; }

void apply(const Checker& checker, const TextureCoordinates& at, Vec3d& color) {
  if (is_odd(std::floor(at.u * checker.fu) + std::floor(at.v * checker.fv)))
    color = {checker.color.x, checker.color.y, checker.color.z};
}

}  // namespace

Hit hit_at(const World::Parts& w, const RayQuery& q, const Boundary& b) {
  const Leaf& leaf = w.leaves[b.leaf];
  const SurfacePoint local = surface_at(leaf, to_local(leaf, q), b.t, b.leaf_entering);
  const WorldPoint place = to_world(w.placements[b.leaf], local.point);
  const Vec3d outward = normal_to_world(leaf, local.normal);
  const LeafSurface& surface = w.surfaces[b.leaf];

  Hit hit;
  hit.t = b.t;
  hit.point = place.point, hit.point_error = place.error;
  hit.normal = b.leaf_entering == b.entering ? outward : -outward;
  hit.color = surface.color;
  if (surface.textures > 0) {
    const TextureCoordinates at = texture_at(leaf, local);
    for (std::uint32_t i = 0; i < surface.textures; ++i)
      std::visit([&](const auto& texture) { apply(texture, at, hit.color); },
                 w.textures[surface.first_texture + i]);
  }
  hit.material = &w.materials[surface.material];
  hit.leaf = b.leaf;
  hit.leaf_entering = b.leaf_entering, hit.entering = b.entering;
  return hit;
}

Ray ray_from(const Hit& hit, const Vec3d& direction, bool outside) {
  // Outside the material is outside the leaf, unless the leaf was subtracted.
  const bool leaf_is_material = hit.leaf_entering == hit.entering;
  return {hit.point, direction, hit.point_error, hit.leaf, outside != leaf_is_material};
}

}  // namespace rayfarm
