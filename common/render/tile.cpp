#include "common/render/tile.h"

#include <algorithm>
#include <numeric>

namespace rayfarm {
namespace {

constexpr std::uint32_t ceil_div(std::uint32_t a, std::uint32_t b) { return (a + b - 1) / b; }

/// Twice the offset of the tile's centre from the film's, squared: whole numbers keep ties exact.
std::int64_t distance_to_centre(Size film, const Tile& tile) {
  const std::int64_t dx = std::int64_t{tile.x0} + tile.x1 - film.width;
  const std::int64_t dy = std::int64_t{tile.y0} + tile.y1 - film.height;
  return dx * dx + dy * dy;
}

}  // namespace

bool is_piece(const Tile& area, const Tile& tile) {
  const bool is_within = tile.x0 <= area.x0 && area.x1 <= tile.x1 && tile.y0 <= area.y0 && area.y1 <= tile.y1;
  const bool is_on_grid = area.x0 % pass_stride[0] == 0 && area.y0 % pass_stride[0] == 0;
  return is_within && is_on_grid && area.x0 < area.x1 && area.y0 < area.y1;
}

std::uint32_t tile_count(Size film) {
  return ceil_div(film.width, tile_side) * ceil_div(film.height, tile_side);
}

Tile tile_at(Size film, std::uint32_t number) {
  const std::uint32_t columns = ceil_div(film.width, tile_side);
  const std::uint32_t x0 = number % columns * tile_side, y0 = number / columns * tile_side;
  return {x0, y0, std::min(x0 + tile_side, film.width), std::min(y0 + tile_side, film.height)};
}

std::vector<std::uint32_t> centre_first(Size film) {
  std::vector<std::int64_t> distance(tile_count(film));
  for (std::uint32_t i = 0; i < distance.size(); ++i)
    distance[i] = distance_to_centre(film, tile_at(film, i));
  std::vector<std::uint32_t> order(distance.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return distance[i]; });
  return order;
}

std::uint32_t pixel_count(const Tile& tile, int pass) {
  const auto on_grid = [&](std::uint32_t stride) {
    return ceil_div(tile.x1 - tile.x0, stride) * ceil_div(tile.y1 - tile.y0, stride);
  };
  const std::uint32_t stride = pass_stride[pass];
  return on_grid(stride) - (pass == 0 ? 0 : on_grid(2 * stride));
}

}  // namespace rayfarm
