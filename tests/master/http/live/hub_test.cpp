#include "master/http/live/hub.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "master/http/api_error.h"
#include "master/http/live/json.h"
#include "tests/support/layer_view.h"

namespace rayfarm {
namespace {

using nlohmann::json;

const LayerName picture{JobId{7}, {}, "picture", "", false}, depth{JobId{7}, {}, "depth", "majority", false};

/// One tile of a layer of 64x64, all of this value.
LiveNews tile_news(std::uint32_t id, float value, LayerProgress progress = LayerProgress::making) {
  LayerState state;
  state.size = {64, 64}, state.state = progress;
  const TileNews tile{0, all_passes, std::vector<float>(64 * 64, value)};
  LiveNews news;
  news.layers.push_back({id, {state, 1, {{0, tile_message({id, {64, 64}, 1, 1}, tile)}}, true}});
  return news;
}

LiveNews state_news(const char* words) {
  LiveNews news;
  news.state = text_message(words);
  return news;
}

json text_of(const LiveMessage& message) {
  EXPECT_TRUE(message.is_text);
  return json::parse(*message.bytes);
}

TEST(LiveHub, AViewerSeesTheNewestStateOnce) {
  LiveHub hub;
  Viewer viewer;
  EXPECT_TRUE(hub.wish().state_is_missing);
  EXPECT_FALSE(viewer.next(hub.board()));
  hub.take(state_news("one"));
  hub.take(state_news("two"));
  EXPECT_EQ(text_of(*viewer.next(hub.board())), "two");
  EXPECT_FALSE(viewer.next(hub.board()));
  EXPECT_FALSE(hub.wish().state_is_missing);
}

TEST(LiveHub, AllLinesOfTheLogArriveInOrder) {
  LiveHub hub;
  Viewer viewer;
  LiveNews news;
  news.lines = {{41, {}, {false, "a", ""}}, {42, {}, {true, "b", "pc7"}}};
  hub.take(news);
  EXPECT_EQ(hub.wish().log_after, 42u);
  news.lines = {{43, {}, {false, "c", ""}}};
  hub.take(news);
  const json all = text_of(*viewer.next(hub.board()));
  EXPECT_EQ(all["type"], "log");
  ASSERT_EQ(all["lines"].size(), 3u);
  EXPECT_EQ(all["lines"][1]["number"], 42);
  EXPECT_EQ(all["lines"][1]["worker"], "pc7");
  EXPECT_TRUE(all["lines"][1]["warning"]);
  EXPECT_FALSE(viewer.next(hub.board()));
}

TEST(LiveHub, AllWhoWatchALayerShareItsBuffers) {
  LiveHub hub;
  Viewer one, other;
  one.watch({hub.feed(picture)});
  other.watch({hub.feed(picture)});
  ASSERT_EQ(hub.wish().layers.size(), 1u);
  hub.take(tile_news(hub.wish().layers[0].id, 1));
  const json layer = text_of(*one.next(hub.board()));
  EXPECT_EQ(layer["type"], "layer");
  EXPECT_EQ(layer["job"], 7);
  EXPECT_EQ(layer["width"], 64);
  EXPECT_EQ(layer["state"], "making");
  EXPECT_TRUE(layer["range"].is_null());
  text_of(*other.next(hub.board()));
  const SharedMessage tile = one.next(hub.board())->bytes;
  EXPECT_EQ(tile, other.next(hub.board())->bytes);
  EXPECT_FALSE(one.next(hub.board()));
}

TEST(LiveHub, OfATileOnlyTheNewestIsSent) {
  LiveHub hub;
  Viewer viewer;
  viewer.watch({hub.feed(picture)});
  const std::uint32_t id = hub.wish().layers[0].id;
  for (const float value : {1.0f, 2.0f, 3.0f}) hub.take(tile_news(id, value));
  text_of(*viewer.next(hub.board()));
  EXPECT_EQ(received_tile(*viewer.next(hub.board())->bytes).values[0], 3.0f);
  EXPECT_FALSE(viewer.next(hub.board()));
}

TEST(LiveHub, ALayerThatIsStillWatchedGoesOnUnderItsNewPlace) {
  LiveHub hub;
  Viewer viewer;
  viewer.watch({hub.feed(picture)});
  hub.take(tile_news(hub.wish().layers[0].id, 1));
  while (viewer.next(hub.board())) {}
  viewer.watch({hub.feed(depth), hub.feed(picture)});
  EXPECT_EQ(text_of(*viewer.next(hub.board()))["watch"], 1);
  EXPECT_FALSE(viewer.next(hub.board()));  // no tile again
}

TEST(LiveHub, WhatNobodyWatchesOrIsDoneIsNotLookedUp) {
  LiveHub hub;
  Viewer viewer;
  viewer.watch({hub.feed(picture), hub.feed(depth)});
  EXPECT_EQ(hub.wish().layers.size(), 2u);
  viewer.watch({hub.feed(picture)});
  ASSERT_EQ(hub.wish().layers.size(), 1u);
  hub.take(tile_news(hub.wish().layers[0].id, 1, LayerProgress::done));
  EXPECT_TRUE(hub.wish().layers.empty());
  EXPECT_EQ(text_of(*viewer.next(hub.board()))["state"], "done");
  EXPECT_TRUE(viewer.next(hub.board()));
}

TEST(LiveHub, ALayerWatchedTwiceIsSentOnce) {
  LiveHub hub;
  Viewer viewer;
  viewer.watch({hub.feed(picture), hub.feed(picture)});
  hub.take(tile_news(hub.wish().layers.at(0).id, 1));
  EXPECT_EQ(text_of(*viewer.next(hub.board()))["watch"], 0);
  EXPECT_EQ(text_of(*viewer.next(hub.board()))["watch"], 1);
  EXPECT_FALSE(viewer.next(hub.board())->is_text);
  EXPECT_FALSE(viewer.next(hub.board()));
}

TEST(LiveHub, LayersThatTakeTooMuchMemoryAreGivenUpTheLastFirst) {
  LiveHub hub(20'000);  // one tile of 64x64 floats
  Viewer viewer;
  viewer.watch({hub.feed(picture), hub.feed(depth)});
  for (const LiveWish::Layer& layer : hub.wish().layers) hub.take(tile_news(layer.id, 1));
  EXPECT_EQ(hub.feed(picture)->state()->state, LayerProgress::making);
  EXPECT_EQ(hub.feed(depth)->state()->state, LayerProgress::failed);
  EXPECT_FALSE(hub.feed(depth)->next_after(0));
}

TEST(LayersToWatch, AreReadStrictly) {
  const auto read = layers_to_watch(
      R"({"watch":[{"job":7,"layer":"picture"},{"job":8,"layer":"depth","reduce":"mean","compat":true},{"job":7,"layer":"depth"},{"job":7,"frame":12}]})");
  ASSERT_EQ(read.size(), 4u);
  EXPECT_EQ(read[0], picture);
  EXPECT_EQ(read[1], (LayerName{JobId{8}, {}, "depth", "mean", true}));
  EXPECT_EQ(read[2], depth);
  EXPECT_EQ(read[3], (LayerName{JobId{7}, 12, "picture", "", false}));
  EXPECT_TRUE(layers_to_watch(R"({"watch":[]})").empty());
  for (
      const char* wrong :
      {"", "7", "[]", "{}", R"({"watch":7})", R"({"watch":[7]})", R"({"watch":[{}]})",
       R"({"watch":[{"job":"7"}]})", R"({"watch":[{"job":-1}]})", R"({"watch":[{"job":1,"layer":7}]})",
       R"({"watch":[{"job":1,"layer":"depth","compat":1}]})", R"({"watch":[{"job":1,"frame":-1}]})",
       R"({"watch":[{"job":1,"frame":"1"}]})", R"({"watch":[],"more":1})",
       R"({"watch":[{"job":1},{"job":1},{"job":1},{"job":1},{"job":1},{"job":1},{"job":1},{"job":1},{"job":1}]})"})
    EXPECT_THROW(layers_to_watch(wrong), ApiError) << wrong;
}

}  // namespace
}  // namespace rayfarm
