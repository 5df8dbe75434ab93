#include "common/render/film.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <random>

namespace rayfarm {
namespace {

const std::vector<Size> sizes{{1, 1}, {5, 3}, {64, 64}, {65, 63}, {130, 71}, {9, 200}};

float value_at(std::uint32_t x, std::uint32_t y, int channel) {
  return static_cast<float>(1 + x + 1000 * y) + 0.25f * static_cast<float>(channel);
}

PassImage image_of(Size film, std::uint32_t tile, int pass) {
  PassImage image{.pass = pass, .rgb = {}, .counters = {}};
  for_each_pixel(tile_at(film, tile), pass, [&](std::uint32_t x, std::uint32_t y) {
    for (int c = 0; c < 3; ++c) image.rgb.push_back(value_at(x, y, c));
  });
  return image;
}

struct Piece {
  std::uint32_t tile;
  int pass;
};

std::vector<Piece> shuffled_pieces(Size film, std::mt19937& random) {
  std::vector<Piece> pieces;
  for (std::uint32_t tile = 0; tile < tile_count(film); ++tile)
    for (int pass = 0; pass < pass_count; ++pass) pieces.push_back({tile, pass});
  std::ranges::shuffle(pieces, random);
  return pieces;
}

/// What filled() must show, straight from its sentence: the nearest corner up-left, in a square of 1, 2, 4
/// or 8.
float shown_at(const Film& film, std::uint32_t x, std::uint32_t y, int channel) {
  const std::uint32_t columns = (film.size().width + tile_side - 1) / tile_side;
  const PassSet there = film.passes_of(y / tile_side * columns + x / tile_side);
  for (std::uint32_t stride = 1; stride <= 8; stride *= 2) {
    const std::uint32_t x0 = x - x % stride, y0 = y - y % stride;
    int pass = 0;
    while (x0 % pass_stride[pass] != 0 || y0 % pass_stride[pass] != 0) ++pass;
    if (there & 1u << pass) return value_at(x0, y0, channel);
  }
  return 0;
}

TEST(Film, GivesBackThePassesThatWerePut) {
  std::mt19937 random(1);
  for (const Size size : sizes) {
    Film film(size);
    for (const auto& [tile, pass] : shuffled_pieces(size, random)) film.put(tile, image_of(size, tile, pass));
    for (const auto& [tile, pass] : shuffled_pieces(size, random))
      EXPECT_EQ(film.pass_pixels(tile, pass), image_of(size, tile, pass).rgb);
  }
}

TEST(Film, CountsPixelsAndIsCompleteExactlyWhenAllPassesOfAllTilesAreThere) {
  std::mt19937 random(2);
  for (const Size size : sizes) {
    Film film(size);
    std::uint64_t pixels = 0;
    for (const auto& [tile, pass] : shuffled_pieces(size, random)) {
      EXPECT_FALSE(film.passes_of(tile) & 1 << pass);
      film.put(tile, image_of(size, tile, pass));
      EXPECT_TRUE(film.passes_of(tile) & 1 << pass);
      pixels += pixel_count(tile_at(size, tile), pass);
      EXPECT_EQ(film.pixels_done(), pixels);
      EXPECT_EQ(film.is_complete(), pixels == std::uint64_t{size.width} * size.height);
    }
    EXPECT_TRUE(film.is_complete());
  }
}

TEST(Film, IsThePictureOfItsPixelsWhenComplete) {
  std::mt19937 random(3);
  for (const Size size : sizes) {
    Film film(size);
    for (const auto& [tile, pass] : shuffled_pieces(size, random)) film.put(tile, image_of(size, tile, pass));
    std::size_t i = 0;
    for (std::uint32_t y = 0; y < size.height; ++y)
      for (std::uint32_t x = 0; x < size.width; ++x)
        for (int c = 0; c < 3; ++c) ASSERT_EQ(film.rgb()[i++], value_at(x, y, c));
    EXPECT_TRUE(std::ranges::equal(film.filled(), film.rgb()));
  }
}

TEST(Film, ShowsMissingPixelsAsSquaresOfCoarserOnesWhateverIsThere) {
  std::mt19937 random(4);
  for (const Size size : sizes) {
    Film film(size);
    for (const auto& [tile, pass] : shuffled_pieces(size, random)) {
      film.put(tile, image_of(size, tile, pass));
      const std::vector<float> shown = film.filled();
      std::size_t i = 0;
      for (std::uint32_t y = 0; y < size.height; ++y)
        for (std::uint32_t x = 0; x < size.width; ++x)
          for (int c = 0; c < 3; ++c) ASSERT_EQ(shown[i++], shown_at(film, x, y, c)) << x << "," << y;
    }
  }
}

TEST(Film, PixelsNotThereYetAreBlack) {
  Film film({70, 10});
  film.put(1, image_of({70, 10}, 1, 0));
  for (std::uint32_t x = 0; x < 64; ++x) EXPECT_EQ(film.rgb()[3 * x], 0.0f);
  EXPECT_EQ(film.rgb()[3 * 64], value_at(64, 0, 0));
  EXPECT_EQ(film.rgb()[3 * 65], 0.0f);
}

#ifndef RAYFARM_SANITIZED  // which clears what calloc() knows to be zero
/// What the program keeps in memory now, in bytes.
std::uint64_t memory_in_use() {
  std::uint64_t all_pages = 0, pages_in_use = 0;
  std::ifstream("/proc/self/statm") >> all_pages >> pages_in_use;
  return pages_in_use * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

TEST(Film, TakesMemoryForThePixelsThatAreThereOnly) {
  const std::uint64_t before = memory_in_use();
  Film film({20'000, 10'000});  // 2.4 GB
  film.put(77, image_of({20'000, 10'000}, 77, 0));
  EXPECT_LT(memory_in_use() - before, 100u << 20);
}
#endif

}  // namespace
}  // namespace rayfarm
