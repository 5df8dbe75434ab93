#include "common/render/tile.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rayfarm {
namespace {

const std::vector<Size> odd_sizes{{1, 1},   {1, 64},  {63, 65},   {64, 64},   {65, 1},   {7, 200},
                                  {200, 7}, {127, 3}, {129, 130}, {640, 480}, {321, 243}};

TEST(Tile, TilesPartitionTheFilm) {
  for (const Size film : odd_sizes) {
    std::vector<int> covered(std::size_t{film.width} * film.height);
    for (std::uint32_t t = 0; t < tile_count(film); ++t) {
      const Tile tile = tile_at(film, t);
      for (std::uint32_t y = tile.y0; y < tile.y1; ++y)
        for (std::uint32_t x = tile.x0; x < tile.x1; ++x) ++covered.at(std::size_t{y} * film.width + x);
    }
    EXPECT_TRUE(std::ranges::all_of(covered, [](int n) { return n == 1; }))
        << film.width << "x" << film.height;
  }
}

TEST(Tile, PassesPartitionATileOfEverySize) {
  for (std::uint32_t height = 1; height <= tile_side; ++height)
    for (std::uint32_t width = 1; width <= tile_side; ++width) {
      const Tile tile{64, 128, 64 + width, 128 + height};
      std::vector<int> covered(width * height);
      for (int pass = 0; pass < pass_count; ++pass) {
        std::uint32_t visited = 0;
        for_each_pixel(tile, pass, [&](std::uint32_t x, std::uint32_t y) {
          ++covered.at((y - tile.y0) * width + (x - tile.x0));
          ++visited;
        });
        ASSERT_EQ(visited, pixel_count(tile, pass)) << width << "x" << height << " pass " << pass;
      }
      ASSERT_TRUE(std::ranges::all_of(covered, [](int n) { return n == 1; })) << width << "x" << height;
    }
}

TEST(Tile, APassHoldsThePixelsOfItsGridThatNoCoarserPassHoldsRowByRow) {
  const Tile tile = tile_at({131, 150}, 1);
  for (int pass = 0; pass < pass_count; ++pass) {
    const std::uint32_t stride = pass_stride[pass];
    std::vector<Pixel> expected, visited;
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y)
      for (std::uint32_t x = tile.x0; x < tile.x1; ++x) {
        const bool on_grid = x % stride == 0 && y % stride == 0;
        const bool coarser = pass > 0 && x % (2 * stride) == 0 && y % (2 * stride) == 0;
        if (on_grid && !coarser) expected.push_back({x, y});
      }
    for_each_pixel(tile, pass, [&](std::uint32_t x, std::uint32_t y) { visited.push_back({x, y}); });
    EXPECT_EQ(visited, expected);
  }
}

TEST(Tile, CentreFirstIsAPermutationOfGrowingDistance) {
  for (const Size film : odd_sizes) {
    const std::vector<std::uint32_t> order = centre_first(film);
    const auto distance = [&](std::uint32_t number) {
      const Tile t = tile_at(film, number);
      const double dx = (t.x0 + t.x1) / 2.0 - film.width / 2.0, dy = (t.y0 + t.y1) / 2.0 - film.height / 2.0;
      return dx * dx + dy * dy;
    };
    EXPECT_TRUE(std::ranges::is_sorted(order, {}, distance));
    std::vector<std::uint32_t> sorted = order;
    std::ranges::sort(sorted);
    for (std::uint32_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i);
    EXPECT_EQ(sorted.size(), tile_count(film));
  }
}

TEST(Tile, TheLargestFilmHasItsTiles) {
  EXPECT_EQ(tile_count({60'000, 8'333}), 938u * 131u);
  EXPECT_EQ(tile_at({60'000, 8'333}, 938 * 131 - 1), (Tile{59'968, 8'320, 60'000, 8'333}));
}

}  // namespace
}  // namespace rayfarm
