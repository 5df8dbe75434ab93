#include "common/render/hit.h"

#include <bit>
#include <cmath>

#include "common/math/hash.h"
#include "common/math/overload.h"

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

// Images. ---------------------------------------------------------------------------------------------------

/// Which of `count` pixels in a row, repeated without end; whole is a whole number.
std::size_t wrapped(double whole, std::uint32_t count) {
  const double pixel = whole - count * std::floor(whole / count);
  return least(pixel, count - 1.0) > 0 ? static_cast<std::size_t>(least(pixel, count - 1.0)) : 0;
}

/// A place on the endless image, in pixels from its upper left corner, y downwards.
struct ImagePlace {
  double x, y;
};
ImagePlace place_in(const Image& image, const ImageTexture& texture, const TextureCoordinates& at) {
  return {at.u * texture.fu * image.width, image.height - at.v * texture.fv * image.height};
}

Vec3d pixel_at(const Image& image, double x, double y) {
  return linear_at(image, wrapped(x, image.width), wrapped(y, image.height));
}

Vec3d color_of(const Image& image, const ImageTexture& texture, const TextureCoordinates& at) {
  const ImagePlace place = place_in(image, texture, at);
  if (!texture.smooth) return pixel_at(image, std::floor(place.x), std::floor(place.y));
  const double left = std::floor(place.x - 0.5), top = std::floor(place.y - 0.5);
  const double right_share = place.x - 0.5 - left, lower_share = place.y - 0.5 - top;
  const auto row = [&](double y) {
    return pixel_at(image, left, y) * (1 - right_share) + pixel_at(image, left + 1, y) * right_share;
  };
  return row(top) * (1 - lower_share) + row(top + 1) * lower_share;
}

const Image& image_of(const World::Parts& w, const ImageTexture& texture) {
  return std::get<Image>(*w.scene.assets[texture.asset].content());
}

std::uint64_t cell_hash(const Image& image, const ImageTexture& texture, const TextureCoordinates& at) {
  const ImagePlace place = place_in(image, texture, at);
  return keyed(wrapped(std::floor(place.x), image.width), wrapped(std::floor(place.y), image.height));
}

void apply(const World::Parts& w, const Texture& texture, const TextureCoordinates& at, Vec3d& color) {
  std::visit(Overload{[&](const ImageTexture& image) { color = color_of(image_of(w, image), image, at); },
                      [&](const auto& squares) { apply(squares, at, color); }},
             texture);
}

std::uint64_t cell_hash(const World::Parts& w, const Texture& texture, const TextureCoordinates& at) {
  return std::visit(
      Overload{[&](const ImageTexture& image) { return cell_hash(image_of(w, image), image, at); },
               [&](const auto& squares) { return cell_hash(squares, at); }},
      texture);
}

/// The surface of a leaf where a ray passes it.
FacetPoint local_surface(const Leaf& leaf, const RayQuery& q, const FacetCrossing& c) {
  if (leaf.facets) return facet_at(leaf, to_local(leaf, q), c);
  return {surface_at(leaf, to_local(leaf, q), c.t, c.entering), 0, {}};
}

TextureCoordinates texture_of(const Leaf& leaf, const FacetPoint& local) {
  return leaf.facets ? local.texture : texture_at(leaf, local.surface);
}

}  // namespace

Hit hit_at(const World::Parts& w, const RayQuery& q, const Boundary& b) {
  const Leaf& leaf = w.leaves[b.leaf];
  const FacetPoint local = local_surface(leaf, q, {b.t, b.error, b.part, b.leaf_entering});
  const Placement& placement = w.placements[b.leaf];
  const WorldPoint place =
      leaf.facets ? to_world(placement, local) : to_world(placement, local.surface.point);
  const Vec3d outward = normal_to_world(leaf, local.surface.normal);
  const LeafSurface& surface = w.surfaces[b.leaf];

  Hit hit;
  hit.t = b.t, hit.t_error = b.error;
  hit.point = place.point, hit.point_error = place.error;
  hit.normal = b.leaf_entering == b.entering ? outward : -outward;
  hit.color = surface.color;
  if (surface.textures > 0) {
    const TextureCoordinates at = texture_of(leaf, local);
    for (std::uint32_t i = 0; i < surface.textures; ++i)
      apply(w, w.textures[surface.first_texture + i], at, hit.color);
  }
  hit.material = &w.materials[surface.material];
  hit.leaf = b.leaf, hit.surface = leaf.surface;
  hit.leaf_entering = b.leaf_entering, hit.entering = b.entering;
  hit.inner = b.inner, hit.outer = b.outer;
  hit.index = b.inner == unknown_medium ? hit.material->index : index_of(w, b.inner) / index_of(w, b.outer);
  hit.is_sheet = leaf.is_sheet(), hit.part = b.part;
  return hit;
}

Vec3d facet_normal(const World::Parts& w, const Ray& ray, const Hit& hit) {
  const Leaf& leaf = w.leaves[hit.leaf];
  if (!leaf.facets) return hit.normal;
  const FacetCrossing crossing{hit.t, 0, hit.part, hit.leaf_entering};
  const FacetPoint local = point_at(*leaf.facets, to_local(leaf, RayQuery(ray)), crossing, false);
  const Vec3d outward = normal_to_world(leaf, local.surface.normal);
  return hit.leaf_entering == hit.entering ? outward : -outward;
}

std::uint64_t texture_cells(const World::Parts& w, const Ray& ray, const Hit& hit) {
  const Leaf& leaf = w.leaves[hit.leaf];
  const FacetPoint local = local_surface(leaf, RayQuery(ray), {hit.t, 0, hit.part, hit.leaf_entering});
  const TextureCoordinates at = texture_of(leaf, local);
  const LeafSurface& surface = w.surfaces[hit.leaf];
  std::uint64_t hash = 0;
  for (std::uint32_t i = 0; i < surface.textures; ++i)
    hash = keyed(hash, cell_hash(w, w.textures[surface.first_texture + i], at));
  return hash;
}

Ray ray_from(const Hit& hit, const Vec3d& direction, bool outside) {
  // Outside the material is outside the leaf, unless the leaf was subtracted.
  const bool leaf_is_material = hit.leaf_entering == hit.entering;
  return {hit.point,
          direction,
          hit.point_error,
          hit.surface,
          outside != leaf_is_material,
          hit.inner != unknown_medium || hit.is_sheet ? Side::unknown
          : outside                                   ? Side::outside
                                                      : Side::inside,
          outside ? hit.outer : hit.inner,
          hit.part};
}

}  // namespace rayfarm
