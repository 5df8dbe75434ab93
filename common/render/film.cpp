#include "common/render/film.h"

#include <algorithm>
#include <cassert>

namespace rayfarm {
namespace {

std::size_t float_index(Size film, std::uint32_t x, std::uint32_t y) {
  return 3 * (std::size_t{y} * film.width + x);
}

/// Paints the pixels of one pass as squares of their stride, clipped at the tile.
void paint_squares(const ZeroedVector<float>& pixels, std::vector<float>& picture, Size film,
                   const Tile& tile, int pass) {
  for_each_pixel(tile, pass, [&](std::uint32_t x0, std::uint32_t y0) {
    const std::uint32_t x1 = std::min(x0 + pass_stride[pass], tile.x1);
    const std::uint32_t y1 = std::min(y0 + pass_stride[pass], tile.y1);
    const float* value = &pixels[float_index(film, x0, y0)];
    for (std::uint32_t y = y0; y < y1; ++y)
      for (std::uint32_t x = x0; x < x1; ++x) std::copy_n(value, 3, &picture[float_index(film, x, y)]);
  });
}

}  // namespace

Film::Film(Size size)
    : size_(size), rgb_(3 * std::size_t{size.width} * size.height), done_(tile_count(size)) {}

void Film::put(std::uint32_t tile, const PassImage& image) {
  const Tile area = tile_at(size_, tile);
  const std::uint32_t count = pixel_count(area, image.pass);
  assert(image.rgb.size() == 3 * std::size_t{count} && "a pass must have all of its pixels");
  assert(!(done_[tile] & 1u << image.pass) && "a pass is put once");

  const float* value = image.rgb.data();
  for_each_row(area, image.pass, [&](std::uint32_t y, std::uint32_t first, std::uint32_t step) {
    float* row = &rgb_[float_index(size_, 0, y)];
    if (step == 1) {  // most pixels are in such rows
      const std::size_t floats = 3 * std::size_t{area.x1 - first};
      std::copy_n(value, floats, row + 3 * std::size_t{first});
      value += floats;
      return;
    }
    for (std::uint32_t x = first; x < area.x1; x += step, value += 3)
      std::copy_n(value, 3, row + 3 * std::size_t{x});
  });
  done_[tile] |= static_cast<PassSet>(1u << image.pass);
  pixels_done_ += count;
}

void Film::take_out(std::uint32_t tile, PassSet passes) {
  assert((done_[tile] & passes) == passes && "the passes must be there");
  const Tile area = tile_at(size_, tile);
  for (int pass = 0; pass < pass_count; ++pass) {
    if (!(passes >> pass & 1)) continue;
    for_each_pixel(area, pass, [&](std::uint32_t x, std::uint32_t y) {
      std::fill_n(&rgb_[float_index(size_, x, y)], 3, 0.0f);
    });
    pixels_done_ -= pixel_count(area, pass);
  }
  done_[tile] &= ~passes;
}

std::vector<float> Film::pass_pixels(std::uint32_t tile, int pass) const {
  assert(done_[tile] & 1u << pass && "the pass must be there");
  return pass_pixels(tile_at(size_, tile), pass);
}

std::vector<float> Film::pass_pixels(const Tile& piece, int pass) const {
  std::vector<float> rgb(3 * std::size_t{pixel_count(piece, pass)});
  float* value = rgb.data();
  for_each_pixel(piece, pass, [&](std::uint32_t x, std::uint32_t y) {
    std::copy_n(&rgb_[float_index(size_, x, y)], 3, value);
    value += 3;
  });
  return rgb;
}

std::vector<float> Film::filled() const {
  std::vector<float> rgb(rgb_.begin(), rgb_.end());
  for (std::uint32_t tile = 0; tile < done_.size(); ++tile) {
    if (done_[tile] == all_passes) continue;
    // Coarse first: a finer square lies within a coarser one and replaces its part of it.
    for (int pass = 0; pass < pass_count; ++pass)
      if (done_[tile] & 1u << pass) paint_squares(rgb_, rgb, size_, tile_at(size_, tile), pass);
  }
  return rgb;
}

}  // namespace rayfarm
