#include "master/diagnostics/delivery_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size size{130, 70};  // six tiles
const MapKind& worker = *map_named("worker");
const MapKind& cost = *map_named("cost");

/// Half rendered by the master's own thread pass by pass, a tile then by a worker; each delivery took a second.
struct Shared {
  Farm farm;
  FakeWorker local{farm, {.name = "master", .kind = WorkerKind::local}};
  JobId job = farm.submit(job_of(size), 0s);
  FarmTime now{};

  Shared() {
    for (int i = 0; i < 8; ++i) local.finish_one(now += 10s);
    FakeWorker lab(farm, {.name = "lab"}, now);
    lab.finish_one(now += 10s);
    farm.remove_worker(lab.id(), "", now);
  }
  Deliveries deliveries() const { return farm.deliveries(job).value(); }
  Map map(const MapKind& kind) const { return delivery_map(deliveries(), size, kind); }
};

TEST(DeliveryMap, TheWorkerIsTheOneWhosePassHoldsThePixel) {
  const Shared shared;
  const Map map = shared.map(worker);
  const Deliveries deliveries = shared.deliveries();
  std::array<std::uint64_t, 2> pixels{};
  for (std::uint32_t tile = 0; tile < tile_count(size); ++tile)
    for (int pass = 0; pass < pass_count; ++pass)
      if (deliveries.tiles[tile].passes >> pass & 1)
        for_each_pixel(tile_at(size, tile), pass, [&](std::uint32_t x, std::uint32_t y) {
          EXPECT_EQ(map.values[y * size.width + x], deliveries.tiles[tile].by[pass]);
          ++pixels[deliveries.tiles[tile].by[pass]];
        });
  EXPECT_GT(pixels[0], 0u);
  EXPECT_GT(pixels[1], 0u);
}

std::vector<float> there(const Map& map) {
  std::vector<float> values;
  std::ranges::copy_if(map.values, std::back_inserter(values), [](float v) { return std::isfinite(v); });
  return values;
}

TEST(DeliveryMap, TheCostsOfAllPixelsAddUpToTheJobsThreadTime) {
  const Shared shared;
  double sum = 0;
  for (const float seconds : there(shared.map(cost))) sum += seconds;
  EXPECT_NEAR(sum, 9, 1e-4);
}

TEST(DeliveryMap, NewsAreTheMapsPixelsTileByTile) {
  const Shared shared;
  const std::vector<std::uint32_t> order = centre_first(size);
  for (const MapKind* kind : {&worker, &cost}) {
    const Map map = shared.map(*kind);
    const LayerNews news = delivery_news(shared.deliveries(), size, *kind, order, {}, 99);
    EXPECT_EQ(news.state.state, LayerProgress::making);
    EXPECT_EQ(news.state.labels.size(), kind == &worker ? 2u : 0u);
    for (const TileNews& tile : news.tiles) {
      const Tile area = tile_at(size, tile.tile);
      std::size_t i = 0;
      for (std::uint32_t y = area.y0; y < area.y1; ++y)
        for (std::uint32_t x = area.x0; x < area.x1; ++x)
          if (const float value = map.values[y * size.width + x]; std::isfinite(value)) {
            ASSERT_EQ(tile.values[i++], value);
          } else {
            ASSERT_EQ(tile.values[i++], 0);
          }
      ASSERT_EQ(i, tile.values.size());
    }
    const auto [low, high] = std::ranges::minmax(there(map));
    EXPECT_EQ((*news.state.range)[1], high);
    EXPECT_GE((*news.state.range)[0], low);
  }
}

TEST(DeliveryMap, NewsAreOfTilesThatHaveMoreThanIsKnown) {
  const Shared shared;
  const Deliveries deliveries = shared.deliveries();
  std::vector<PassSet> known;
  for (const Deliveries::Tile& tile : deliveries.tiles) known.push_back(tile.passes);
  const auto tiles = [&](const std::vector<PassSet>& seen, std::uint32_t most) {
    return delivery_news(deliveries, size, worker, centre_first(size), seen, most).tiles.size();
  };
  EXPECT_EQ(tiles({}, 99), 6u);
  EXPECT_EQ(tiles({}, 4), 4u);
  EXPECT_EQ(tiles(known, 99), 0u);
  known[3] = 0;
  EXPECT_EQ(tiles(known, 99), 1u);
}

TEST(DeliveryMap, IsDoneWithTheLastPixel) {
  Shared shared;
  while (!shared.local.held().empty()) shared.local.finish_one(shared.now += 10s);
  const LayerNews news = delivery_news(shared.deliveries(), size, cost, centre_first(size), {}, 0);
  EXPECT_EQ(news.state.state, LayerProgress::done);
  EXPECT_EQ(news.state.share_done, 1);
}

}  // namespace
}  // namespace rayfarm
