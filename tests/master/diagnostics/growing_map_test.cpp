#include "master/diagnostics/growing_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rayfarm {
namespace {

constexpr Size size{130, 70};  // six tiles

std::vector<float> values_of(std::uint32_t tile, int pass) {
  std::vector<float> values;
  for_each_pixel(tile_at(size, tile), pass, [&](std::uint32_t x, std::uint32_t y) {
    values.push_back(static_cast<float>(x) + 1), values.push_back(-static_cast<float>(y));
  });
  return values;
}

void put(GrowingMap& map, std::uint32_t tile, int pass) { map.put(tile, pass, values_of(tile, pass)); }

TEST(GrowingMap, ComesTogetherInAnyOrder) {
  GrowingMap map(size, 2);
  for (int pass = pass_count - 1; pass >= 0; --pass)
    for (std::uint32_t tile = 0; tile < tile_count(size); ++tile) put(map, tile, pass);
  EXPECT_EQ(map.news({}, 0).state.share_done, 1);
  std::vector<float> expected;
  for (std::uint32_t y = 0; y < size.height; ++y)
    for (std::uint32_t x = 0; x < size.width; ++x)
      expected.insert(expected.end(), {static_cast<float>(x) + 1, -static_cast<float>(y)});
  EXPECT_EQ(map.whole().values, expected);
}

TEST(GrowingMap, TellsTheTilesThatHaveMoreThanIsKnownThoseNearestTheCentreFirst) {
  GrowingMap map(size, 2);
  EXPECT_TRUE(map.news({}, 9).tiles.empty());
  for (const std::uint32_t tile : {0u, 1u, 5u}) put(map, tile, 0);
  put(map, 1, 2);
  const auto numbers = [&](const std::vector<PassSet>& known, std::uint32_t most) {
    std::vector<std::uint32_t> tiles;
    for (const TileNews& news : map.news(known, most).tiles) tiles.push_back(news.tile);
    return tiles;
  };
  EXPECT_EQ(numbers({}, 9), (std::vector<std::uint32_t>{1, 0, 5}));
  EXPECT_EQ(numbers({}, 2), (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(numbers({1, 1, 0, 0, 0, 0}, 9), (std::vector<std::uint32_t>{1, 5}));
  EXPECT_TRUE(numbers({1, 0b101, 0, 0, 0, 1}, 9).empty());
}

TEST(GrowingMap, ATileIsAllItsPixelsThoseNotThereYet0) {
  GrowingMap map(size, 2);
  put(map, 2, 0), put(map, 2, 1);  // two pixels wide
  const TileNews news = map.news({}, 1).tiles.at(0);
  EXPECT_EQ(news.tile, 2u);
  EXPECT_EQ(news.passes, 0b11);
  const Tile tile = tile_at(size, 2);
  std::size_t i = 0;
  for (std::uint32_t y = tile.y0; y < tile.y1; ++y)
    for (std::uint32_t x = tile.x0; x < tile.x1; ++x, i += 2)
      EXPECT_EQ(news.values[i], x % 4 == 0 && y % 4 == 0 ? static_cast<float>(x) + 1 : 0) << x << "," << y;
  EXPECT_EQ(i, news.values.size());
}

TEST(GrowingMap, SoFarCoarserValuesFillTheSquaresOfThoseNotThereYet) {
  GrowingMap map({70, 64}, 1);
  std::vector<float> values(pixel_count(tile_at({70, 64}, 0), 0));
  std::iota(values.begin(), values.end(), 0.0f);
  map.put(0, 0, values);
  const Map coarse = map.so_far();
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t x = 0; x < 70; ++x)
      ASSERT_EQ(coarse.values[y * 70 + x], x < 64 ? static_cast<float>(y / 8 * 8 + x / 8) : INFINITY);
  map.put(0, 1, std::vector<float>(pixel_count(tile_at({70, 64}, 0), 1), -1));
  const Map finer = map.so_far();
  EXPECT_EQ(finer.values[8 * 70 + 8], 9);
  EXPECT_EQ(finer.values[8 * 70 + 12], -1);
  EXPECT_EQ(finer.values[15 * 70 + 15], -1);
}

TEST(GrowingMap, TheRangeIsOfTheFiniteValuesSoFar) {
  GrowingMap map({64, 64}, 1);
  EXPECT_EQ(map.news({}, 0).state.range, std::nullopt);
  std::vector<float> values(64, std::numeric_limits<float>::infinity());
  map.put(0, 0, values);
  EXPECT_EQ(map.news({}, 0).state.range, std::nullopt);
  values.resize(192, 3);
  values[7] = -2, values[8] = std::numeric_limits<float>::quiet_NaN();
  map.put(0, 1, values);
  EXPECT_EQ(map.news({}, 0).state.range, (std::array{-2.0, 3.0}));
}

}  // namespace
}  // namespace rayfarm
