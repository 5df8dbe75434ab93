// The picture's division into work: 64x64 tiles, each in four passes of strides 8, 4, 2, 1.
//
// Source of the idea: Adam7 interlacing (PNG). A pass holds the pixels on its stride's grid that no coarser
// pass holds, so nothing is computed twice; until finer passes come, a pixel's value fills its stride x
// stride square.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace rayfarm {

constexpr std::uint32_t tile_side = 64;
constexpr int pass_count = 4;
constexpr std::array<std::uint32_t, pass_count> pass_stride{8, 4, 2, 1};

/// A set of passes, bit p for pass p (0 is the coarsest).
using PassSet = std::uint8_t;
constexpr PassSet all_passes = 0b1111;

struct Size {
  std::uint32_t width = 0, height = 0;
  bool operator==(const Size&) const = default;
};

struct Pixel {
  std::uint32_t x = 0, y = 0;
  bool operator==(const Pixel&) const = default;
};

/// Half-open: x0 <= x < x1. Tiles at the right and lower edge may be smaller than 64.
struct Tile {
  std::uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool operator==(const Tile&) const = default;
};

/// A part of a tile with passes of its own, which are parts of the tile's: its corner lies on the coarsest grid.
bool is_piece(const Tile& area, const Tile& tile);

/// Number of tiles of a film; tile numbers run row by row from the upper left.
std::uint32_t tile_count(Size film);
Tile tile_at(Size film, std::uint32_t number);
/// All tile numbers, those nearest the film's centre first (ties by number).
std::vector<std::uint32_t> centre_first(Size film);

/// Calls visit(y, first, step) for the rows of one pass: its pixels are at x = first, first + step, ... <
/// tile.x1. The tile must be a film's, or a piece of one: its corner lies on the coarsest grid.
template <class Visit>
void for_each_row(const Tile& tile, int pass, Visit&& visit) {
  const std::uint32_t stride = pass_stride[pass], coarser = 2 * stride;
  for (std::uint32_t y = tile.y0; y < tile.y1; y += stride) {
    const bool row_has_coarser = pass != 0 && y % coarser == 0;
    if (row_has_coarser)
      visit(y, tile.x0 + stride, coarser);
    else
      visit(y, tile.x0, stride);
  }
}

/// Calls visit(x, y) for the pixels of one pass, row by row, in the order in which their values travel.
template <class Visit>
void for_each_pixel(const Tile& tile, int pass, Visit&& visit) {
  for_each_row(tile, pass, [&](std::uint32_t y, std::uint32_t first, std::uint32_t step) {
    for (std::uint32_t x = first; x < tile.x1; x += step) visit(x, y);
  });
}

std::uint32_t pixel_count(const Tile& tile, int pass);

}  // namespace rayfarm
