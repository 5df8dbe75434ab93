#include "master/http/live/layer_feed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "master/http/api_error.h"
#include "master/http/live/half.h"
#include "tests/support/layer_view.h"

namespace rayfarm {
namespace {

/// A layer that grows by hand: the value of each pixel is its place.
class GrowingLayer {
 public:
  GrowingLayer(Size size, std::size_t channels) : size(size), channels(channels), done(tile_count(size)) {}

  float value(std::uint32_t x, std::uint32_t y, std::size_t channel) const {
    return 0.1f + static_cast<float>(y * size.width + x) + 0.25f * static_cast<float>(channel) - lie;
  }
  LayerNews news(const std::vector<PassSet>& known, std::uint32_t most_tiles) const {
    const bool is_done = std::ranges::all_of(done, [](PassSet passes) { return passes == all_passes; });
    LayerNews all;
    all.state.size = size, all.state.channels = channels;
    all.state.state = is_done ? LayerProgress::done : LayerProgress::making;
    all.losses = losses, all.is_final = is_final;
    for (std::uint32_t tile = 0; tile < done.size() && all.tiles.size() < most_tiles; ++tile)
      if (done[tile] & ~(known.empty() ? PassSet{0} : known[tile])) all.tiles.push_back(tile_news(tile));
    return all;
  }
  LayerSource source() const {
    return [this](const auto& known, std::uint32_t most) { return news(known, most); };
  }

  const Size size;
  const std::size_t channels;
  std::vector<PassSet> done;
  std::uint32_t losses = 0;
  bool is_final = true;
  float lie = 0;

 private:
  TileNews tile_news(std::uint32_t number) const {
    const Tile tile = tile_at(size, number);
    TileNews news{number, done[number],
                  std::vector<float>((tile.x1 - tile.x0) * (tile.y1 - tile.y0) * channels)};
    for (int pass = 0; pass < pass_count; ++pass) {
      if (!(done[number] >> pass & 1)) continue;
      for_each_pixel(tile, pass, [&](std::uint32_t x, std::uint32_t y) {
        for (std::size_t c = 0; c < channels; ++c)
          news.values[((y - tile.y0) * (tile.x1 - tile.x0) + x - tile.x0) * channels + c] = value(x, y, c);
      });
    }
    return news;
  }
};

/// A viewer's place in a feed, and what it sees.
struct TestViewer {
  explicit TestViewer(Size size, std::size_t channels) : view(size, channels) {}

  bool take_one(const LayerFeed& feed) {
    const auto next = feed.next_after(place);
    if (!next) return false;
    place = next->place;
    view.put(received_tile(*next->message));
    ++tiles;
    return true;
  }
  LayerView view;
  std::uint64_t place = 0;
  int tiles = 0;
};

struct Step {
  std::uint32_t tile;
  int pass;
};

std::vector<Step> all_steps(Size size) {
  std::vector<Step> steps;
  for (std::uint32_t tile = 0; tile < tile_count(size); ++tile)
    for (int pass = 0; pass < pass_count; ++pass) steps.push_back({tile, pass});
  return steps;
}

void expect_whole(const GrowingLayer& layer, const LayerView& view) {
  ASSERT_TRUE(view.is_complete());
  std::size_t i = 0;
  for (std::uint32_t y = 0; y < layer.size.height; ++y)
    for (std::uint32_t x = 0; x < layer.size.width; ++x)
      for (std::size_t c = 0; c < layer.channels; ++c)
        ASSERT_EQ(view.values()[i++], layer.value(x, y, c)) << x << "," << y;
}

// The law: in whatever order passes come, however often one looks and however slowly a viewer reads, at the end
// all see the layer bit for bit.
TEST(LayerFeed, EveryPixelArrivesInAnyOrderOfPassesAtAnyPaceOfReading) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    GrowingLayer layer({200, 130}, seed % 2 ? 3 : 1);
    LayerPoller poller(7, layer.source());
    LayerFeed feed(7, {});
    TestViewer slow(layer.size, layer.channels), fast = slow, late = slow;
    std::vector<Step> steps = all_steps(layer.size);
    std::shuffle(steps.begin(), steps.end(), random);
    for (const Step& step : steps) {
      layer.done[step.tile] |= 1 << step.pass;
      if (random() % 3 == 0) feed.take(poller.poll(random() % 4));
      while (fast.take_one(feed)) {}
      if (random() % 5 == 0) slow.take_one(feed);
    }
    while (!feed.is_over()) feed.take(poller.poll(3));
    for (TestViewer* viewer : {&slow, &fast, &late}) {
      while (viewer->take_one(feed)) {}
      expect_whole(layer, viewer->view);
    }
    EXPECT_EQ(late.tiles, static_cast<int>(tile_count(layer.size)));  // the newest of each wins
    EXPECT_LE(slow.tiles, fast.tiles);
  }
}

// A worker is found to have lied: viewers had gone on to see its pixels.
TEST(LayerFeed, WhatWasTakenBackIsToldAgainHoweverSoonItIsThere) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    GrowingLayer layer({200, 130}, 1);
    layer.is_final = false, layer.lie = 1;
    LayerPoller poller(7, layer.source());
    LayerFeed feed(7, {});
    TestViewer viewer(layer.size, 1);
    std::vector<Step> steps = all_steps(layer.size);
    std::shuffle(steps.begin(), steps.end(), random);
    const std::size_t of_the_liar = seed % 2 ? steps.size() : random() % steps.size();
    const auto poll = [&] { feed.take(poller.poll(1 + random() % 4)); };
    for (std::size_t i = 0; i < of_the_liar; ++i) {
      layer.done[steps[i].tile] |= 1 << steps[i].pass;
      poll();
      viewer.take_one(feed);
    }
    for (int i = 0; i < 20; ++i) poll();
    EXPECT_FALSE(feed.is_over());
    std::ranges::fill(layer.done, 0);
    ++layer.losses, layer.lie = 0;
    if (random() % 2) poll();
    std::ranges::fill(layer.done, all_passes);
    layer.is_final = true;
    while (!feed.is_over()) poll();
    while (viewer.take_one(feed)) {}
    expect_whole(layer, viewer.view);
  }
}

TEST(LayerFeed, WhatIsUnfinishedIsCoarseAndHalf) {
  GrowingLayer layer({64, 64}, 1);
  LayerPoller poller(7, layer.source());
  const std::uint32_t strides[]{8, 4, 2, 1};
  for (int pass = 0; pass < pass_count; ++pass) {
    layer.done[0] |= 1 << pass;
    const FeedNews news = poller.poll(10);
    ASSERT_EQ(news.tiles.size(), 1u);
    const ReceivedTile tile = received_tile(*news.tiles[0].message);
    EXPECT_EQ(tile.layer, 7u);
    EXPECT_EQ(tile.stride, strides[pass]);
    EXPECT_EQ(tile.is_float32, pass == 3);
    if (pass == 3) continue;
    EXPECT_EQ(tile.values[1], float_of_half(half_of(layer.value(strides[pass], 0, 0))));
  }
  EXPECT_TRUE(poller.poll(10).tiles.empty());
}

TEST(LayerFeed, APassWithoutTheCoarserOnesWaitsForThem) {
  GrowingLayer layer({64, 64}, 1);
  LayerPoller poller(7, layer.source());
  layer.done[0] = 0b0010;
  EXPECT_TRUE(poller.poll(10).tiles.empty());
  layer.done[0] = 0b0011;
  EXPECT_EQ(received_tile(*poller.poll(10).tiles.at(0).message).stride, 4);
}

TEST(LayerFeed, OfAHugePictureEachNthPixelIsSent) {
  EXPECT_EQ(step_for({8192, 3000}), 1u);
  EXPECT_EQ(step_for({8193, 10}), 2u);
  EXPECT_EQ(step_for({8000, 8000}), 2u);
  EXPECT_EQ(step_for({60'000, 100}), 8u);

  GrowingLayer layer({16'500, 70}, 1);  // every fourth
  LayerPoller poller(7, layer.source());
  LayerFeed feed(7, {});
  std::ranges::fill(layer.done, passes_sent(4));  // finer passes are not waited for
  const Size sent{16'500 / 4, 18};
  TestViewer viewer(sent, 1);
  for (bool is_all = false; !is_all;) {
    FeedNews news = poller.poll(50);
    is_all = news.is_all;
    feed.take(std::move(news));
  }
  EXPECT_EQ(feed.step(), 4u);
  while (viewer.take_one(feed)) {}
  ASSERT_TRUE(viewer.view.is_complete());
  for (std::uint32_t y = 0; y < sent.height; ++y)
    for (std::uint32_t x = 0; x < sent.width; ++x)
      ASSERT_EQ(viewer.view.values()[y * sent.width + x], layer.value(4 * x, 4 * y, 0));
  std::ranges::fill(layer.done, all_passes);
  EXPECT_TRUE(poller.poll(50).tiles.empty());
}

TEST(LayerFeed, WhatTheSourceThrowsIsTheLayersState) {
  LayerPoller poller(
      1, [](const auto&, std::uint32_t) -> LayerNews { throw ApiError(409, "job 3 was cancelled"); });
  LayerFeed feed(1, {});
  feed.take(poller.poll(10));
  EXPECT_EQ(feed.state()->state, LayerProgress::failed);
  EXPECT_EQ(feed.state()->message, "job 3 was cancelled");
  const std::uint64_t version = feed.state_version();
  feed.take(poller.poll(10));
  EXPECT_EQ(feed.state_version(), version);  // it is not told again and again
}

}  // namespace
}  // namespace rayfarm
