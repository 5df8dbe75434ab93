#include "common/render/hit.h"

#include <bit>
#include <cmath>

#include "common/math/hash.h"

namespace rayfarm {
namespace {

bool is_odd(double whole) { return whole - 2 * std::floor(whole / 2) == 1; }

/// The square of a checker or of stripes, counted from the origin.
struct Square {
  double u, v;
  bool is_odd() const { return rayfarm::is_odd(u + v); }
  std::uint64_t hash() const {
    return keyed(std::bit_cast<std::uint64_t>(u), std::bit_cast<std::uint64_t>(v));
  }
};
template <class Squares>
Square square_at(const Squares& texture, const TextureCoordinates& at) {
  return {std::floor(at.u * texture.fu), std::floor(at.v * texture.fv)};
}

bool shows_color(const Checker& checker, const TextureCoordinates& at) {
  return square_at(checker, at).is_odd();
}
std::uint64_t cell_hash(const Checker& checker, const TextureCoordinates& at) {
  return square_at(checker, at).hash();
}

/// The half of the square that lies towards u.
bool is_beyond_diagonal(const Stripes& stripes, const TextureCoordinates& at) {
  const Square square = square_at(stripes, at);
  return at.u * stripes.fu - square.u > at.v * stripes.fv - square.v;
}
bool shows_color(const Stripes& stripes, const TextureCoordinates& at) {
  return square_at(stripes, at).is_odd() == is_beyond_diagonal(stripes, at);
}
std::uint64_t cell_hash(const Stripes& stripes, const TextureCoordinates& at) {
  return keyed(square_at(stripes, at).hash(), is_beyond_diagonal(stripes, at));
}

template <class Squares>
void apply(const Squares& texture, const TextureCoordinates& at, Vec3d& color) {
  if (shows_color(texture, at)) color = vec(texture.color);
}

double index_of(const World::Parts& w, std::uint32_t medium) {
  return medium == empty_space ? 1 : w.materials[medium].index;
}

}  // namespace

Hit hit_at(const World::Parts& w, const RayQuery& q, const Boundary& b) {
  const Leaf& leaf = w.leaves[b.leaf];
  const SurfacePoint local = surface_at(leaf, to_local(leaf, q), b.t, b.leaf_entering);
  const WorldPoint place = to_world(w.placements[b.leaf], local.point);
  const Vec3d outward = normal_to_world(leaf, local.normal);
  const LeafSurface& surface = w.surfaces[b.leaf];

  Hit hit;
  hit.t = b.t, hit.t_error = b.error;
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
  hit.inner = b.inner, hit.outer = b.outer;
  hit.index = b.inner == unknown_medium ? hit.material->index : index_of(w, b.inner) / index_of(w, b.outer);
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
          hit.inner != unknown_medium ? Side::unknown
          : outside                   ? Side::outside
                                      : Side::inside,
          outside ? hit.outer : hit.inner};
}

}  // namespace rayfarm
