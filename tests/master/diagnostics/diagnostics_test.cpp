// What the service makes is what is made at once, and only for those who ask.
#include "master/diagnostics/diagnostics.h"

#include <gtest/gtest.h>

#include "tests/support/hand_clock.h"
#include "tests/support/random_scene.h"
#include "tests/support/simple_job.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

const auto never = [] { return false; };
const auto unheard = [](std::uint32_t, std::uint32_t) {};

Subject subject(std::uint64_t seed = 3) {
  const SceneData data = scene_data(random_scene(seed));
  Subject subject{data.hash, data.bytes, {}};
  subject.settings.width = 70, subject.settings.height = 66, subject.settings.spp = 4;
  return subject;
}

struct MadeInTheBackground : testing::Test {
  HandClock clock;
  Diagnostics diagnostics{0, clock.reader()};

  int work() {
    int parts = 0;
    while (diagnostics.work_once()) ++parts;
    return parts;
  }
};

TEST_F(MadeInTheBackground, AMapIsTheOneThatIsMadeAtOnce) {
  for (const MapKind& kind : all_maps()) {
    if (kind.source == MapSource::farm || kind.source == MapSource::time) continue;
    const Subject s = subject();
    const MapRequest request{&kind, Reduction::median, true};
    EXPECT_EQ(diagnostics.map(s, request).thing, nullptr);
    work();
    const Made<Map> made = diagnostics.map(s, request);
    EXPECT_EQ(made.standing.state, LayerProgress::done);
    const auto expected = map_of(World(random_scene(3)), s.settings, request, 1, never, unheard);
    EXPECT_EQ(made.thing->values, expected->values) << kind.name;
    EXPECT_EQ(made.thing->size, expected->size);
    EXPECT_EQ(made.thing->channels, expected->channels);
  }
}

TEST_F(MadeInTheBackground, AMapIsSeenWholeAndCoarseBeforeItIsSeenFine) {
  const std::uint32_t tiles = tile_count({70, 66});
  diagnostics.map_news(subject(), {}, {}, 0);
  for (PassSet passes = 1;; passes = static_cast<PassSet>(2 * passes + 1)) {
    for (std::uint32_t part = 0; part < tiles; ++part) EXPECT_TRUE(diagnostics.work_once());
    const LayerNews news = diagnostics.map_news(subject(), {}, {}, 100);
    ASSERT_EQ(news.tiles.size(), tiles);
    for (const TileNews& tile : news.tiles) EXPECT_EQ(tile.passes, passes);
    if (passes == all_passes) break;
    EXPECT_EQ(news.state.state, LayerProgress::making);
  }
  EXPECT_EQ(diagnostics.map_news(subject(), {}, {}, 0).state.state, LayerProgress::done);
}

TEST_F(MadeInTheBackground, MapsThatCannotDifferAreMadeOnce) {
  const MapRequest count{map_named("primary-rays"), Reduction::mean, true};
  diagnostics.map(subject(), count);
  EXPECT_EQ(work(), 4 * 4);
  diagnostics.map(subject(), {map_named("primary-rays"), Reduction::closest, false});
  EXPECT_EQ(work(), 0);
  Subject other = subject();
  other.settings.seed = 1;
  diagnostics.map(other, count);
  EXPECT_EQ(work(), 4 * 4);
  diagnostics.map(subject(4), count);
  EXPECT_EQ(work(), 4 * 4);
}

TEST_F(MadeInTheBackground, MapsOfTheSameSamplesComeTogether) {
  const MapRequest asked{map_named("depth"), Reduction::mean};
  diagnostics.map(subject(), asked);
  work();
  for (const MapKind& kind : all_maps()) {
    if (kind.source == MapSource::farm) continue;
    const LayerNews news = diagnostics.map_news(subject(), {&kind, Reduction::mean}, {}, 100);
    EXPECT_EQ(news.tiles.size(), kind.source == MapSource::surfaces ? 4u : 0u) << kind.name;
    for (const TileNews& tile : news.tiles) EXPECT_EQ(tile.passes, all_passes) << kind.name;
  }
  const LayerNews other = diagnostics.map_news(subject(), {map_named("depth"), Reduction::closest}, {}, 100);
  EXPECT_TRUE(other.tiles.empty());
}

TEST_F(MadeInTheBackground, MapsThatAreAskedForInTurnsAreTheSame) {
  const Subject s = subject();
  const std::array<MapRequest, 2> requests{{{map_named("depth")}, {map_named("normal")}}};
  for (int i = 0; i < 40; ++i) {
    diagnostics.map(s, requests[static_cast<std::size_t>(i % 2)]);
    diagnostics.work_once();
  }
  for (const MapRequest& request : requests) {
    const auto expected = map_of(World(random_scene(3)), s.settings, request, 1, never, unheard);
    ASSERT_TRUE(diagnostics.map(s, request).thing) << request.kind->name;
    EXPECT_EQ(diagnostics.map(s, request).thing->values, expected->values) << request.kind->name;
  }
}

TEST_F(MadeInTheBackground, StatisticsAreThoseThatAreMadeAtOnce) {
  const Subject s = subject();
  EXPECT_EQ(diagnostics.statistics(s).thing, nullptr);
  EXPECT_EQ(work(), 4);
  EXPECT_EQ(*diagnostics.statistics(s).thing,
            statistics_of(World(random_scene(3)), s.settings, 1, never, unheard));
  EXPECT_EQ(work(), 0);
}

TEST_F(MadeInTheBackground, ACloudIsTheOneThatIsMadeAtOnce) {
  const Subject s = subject();
  for (const PlyForm form : {PlyForm::binary, PlyForm::ascii, PlyForm::compact}) {
    const CloudRequest request{{form, 0.25, false}, 1000};
    EXPECT_EQ(diagnostics.cloud(s, request).thing, nullptr);
    EXPECT_EQ(work(), 1);
    const auto local = small_cloud(World(random_scene(3)), s.settings, request.options, request.points, never,
                                   [](double) {});
    EXPECT_EQ(*diagnostics.cloud(s, request).thing, *local);
  }
}

TEST_F(MadeInTheBackground, NothingIsMadeForNobody) {
  EXPECT_EQ(work(), 0);
  diagnostics.scene(subject());
  EXPECT_EQ(work(), 0);
  diagnostics.map(subject(), {});
  clock.turn(30s);
  EXPECT_EQ(work(), 0);
}

TEST(WhatIsKept, AMapThatIsNoLongerKeptIsMadeAgain) {
  HandClock clock;
  DiagnosticsLimits limits;
  limits.maps.bytes = 70 * 66 * sizeof(float);
  Diagnostics diagnostics(0, clock.reader(), limits);
  const auto make = [&](const char* kind) {
    int parts = 0;
    diagnostics.map(subject(), {map_named(kind)});
    while (diagnostics.work_once()) ++parts;
    clock.turn(30s);
    return parts;
  };
  EXPECT_EQ(make("depth"), 16);
  EXPECT_EQ(make("depth"), 0);
  EXPECT_EQ(make("primary-rays"), 16);
  EXPECT_EQ(make("depth"), 16);
}

TEST(DiagnosticsThreads, MakeEverythingAndEndInTheMiddleOfASlowPixel) {
  Diagnostics diagnostics(2);
  while (diagnostics.map(subject(), {}).standing.state != LayerProgress::done) std::this_thread::yield();
  Subject slow = subject();
  slow.settings.spp = max_spp;
  diagnostics.map(slow, {map_named("all-rays")});
  diagnostics.statistics(slow);
}

TEST(DiagnosticsThreads, ABrokenSceneIsToldToThoseWhoAsk) {
  Diagnostics diagnostics(0);
  Subject broken = subject();
  broken.scene_hash = "broken";
  broken.scene = std::make_shared<const std::vector<std::uint8_t>>(9, std::uint8_t{1});
  diagnostics.map(broken, {});
  EXPECT_TRUE(diagnostics.work_once());
  const Standing standing = diagnostics.map(broken, {}).standing;
  EXPECT_EQ(standing.state, LayerProgress::failed);
  EXPECT_NE(standing.message, "");
}

}  // namespace
}  // namespace rayfarm
