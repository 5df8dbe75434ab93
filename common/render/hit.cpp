#include "common/render/hit.h"

#include <bit>
#include <cmath>

#include "common/math/hash.h"

namespace rayfarm {
namespace {

bool is_odd(double whole) { return whole - 2 * std::floor(whole / 2) == 1; }

/// The checker's square, counted from the origin.
struct Square {
  double u, v;
};
Square square_at(const Checker& checker, const TextureCoordinates& at) {
  return {std::floor(at.u * checker.fu), std::floor(at.v * checker.fv)};
}

void apply(const Checker& checker, const TextureCoordinates& at, Vec3d& color) {
  const Square square = square_at(checker, at);
  if (is_odd(square.u + square.v)) color = {checker.color.x, checker.color.y, checker.color.z};
}

std::uint64_t cell_hash(const Checker& checker, const TextureCoordinates& at) {
  const Square square = square_at(checker, at);
  return keyed(std::bit_cast<std::uint64_t>(square.u), std::bit_cast<std::uint64_t>(square.v));
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

std::uint64_t texture_cells(const World::Parts& w, const Ray& ray, const Hit& hit) {
  const Leaf& leaf = w.leaves[hit.leaf];
  const SurfacePoint local = surface_at(leaf, to_local(leaf, RayQuery(ray)), hit.t, hit.leaf_entering);
  const TextureCoordinates at = texture_at(leaf, local);
  const LeafSurface& surface = w.surfaces[hit.leaf];
  std::uint64_t hash = 0;
  for (std::uint32_t i = 0; i < surface.textures; ++i)
    hash = keyed(hash, std::visit([&](const auto& texture) { return cell_hash(texture, at); },
                                  w.textures[surface.first_texture + i]));
  return hash;
}

Ray ray_from(const Hit& hit, const Vec3d& direction, bool outside) {
  // Outside the material is outside the leaf, unless the leaf was subtracted.
  const bool leaf_is_material = hit.leaf_entering == hit.entering;
  return {hit.point,
          direction,
          hit.point_error,
          hit.leaf,
          outside != leaf_is_material,
          outside ? Side::outside : Side::inside};
}

}  // namespace rayfarm
