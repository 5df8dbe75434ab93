#include "master/diagnostics/world_cache.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "common/net/codec.h"
#include "master/diagnostics/leaf_names.h"
#include "tests/support/random_scene.h"
#include "tests/support/simple_job.h"

namespace rayfarm {
namespace {

SceneData scene(std::uint64_t seed) { return scene_data(random_scene(seed)); }

std::shared_ptr<const ReadyScene> get(WorldCache& cache, std::uint64_t seed) {
  const SceneData data = scene(seed);
  return cache.get(data);
}

TEST(WorldCache, BuildsTheSceneWithTheNamesOfItsLeaves) {
  WorldCache cache({});
  const auto ready = get(cache, 3);
  EXPECT_EQ(ready->world().scene(), random_scene(3));
  EXPECT_EQ(ready->leaf_names(), leaf_names(random_scene(3)));
}

TEST(WorldCache, BuildsAWorldOnceForAllWhoAsk) {
  WorldCache cache({});
  std::mutex mutex;
  std::set<std::shared_ptr<const ReadyScene>> different;
  {
    std::vector<std::jthread> askers;
    for (int i = 0; i < 8; ++i)
      askers.emplace_back([&] {
        const auto ready = get(cache, 3);
        const std::lock_guard lock(mutex);
        different.insert(ready);
      });
  }
  EXPECT_EQ(different.size(), 1u);
}

TEST(WorldCache, DropsWhatWasNotAskedForTheLongest) {
  WorldCache cache({.worlds = 2});
  const std::weak_ptr<const ReadyScene> a = get(cache, 1), b = get(cache, 2);
  get(cache, 1);
  get(cache, 3);
  EXPECT_FALSE(a.expired());
  EXPECT_TRUE(b.expired());
}

TEST(WorldCache, DropsWhatTakesTooManyBytesButNotTheNewest) {
  WorldCache cache({.worlds = 4, .bytes = 1});
  const std::weak_ptr<const ReadyScene> a = get(cache, 1);
  EXPECT_FALSE(a.expired());
  const std::weak_ptr<const ReadyScene> b = get(cache, 2);
  EXPECT_TRUE(a.expired());
  EXPECT_FALSE(b.expired());
}

TEST(WorldCache, AWorldInUseOutlivesItsPlace) {
  WorldCache cache({.worlds = 1});
  const auto ready = get(cache, 1);
  get(cache, 2);
  EXPECT_EQ(ready->world().scene(), random_scene(1));
}

TEST(WorldCache, ABrokenSceneIsToldToEachAskerAndTakesNoPlace) {
  WorldCache cache({.worlds = 1});
  const std::weak_ptr<const ReadyScene> whole = get(cache, 1);
  const auto broken = std::make_shared<const std::vector<std::uint8_t>>(9, std::uint8_t{1});
  for (int i = 0; i < 2; ++i) EXPECT_THROW(cache.get({"broken", broken}), CodecError);
  EXPECT_NE(get(cache, 1), nullptr);
}

TEST(WorldCache, CountsAWorldsBytesByItsParts) {
  const std::uint64_t one = bytes_of(World(simple_scene()));
  Scene two = simple_scene();
  two.nodes.insert(two.nodes.begin(), Node{Operation{CsgOp::unite, 2}, {}, {}, {}, {}, ""});
  two.nodes.push_back(two.nodes[1]);
  EXPECT_GT(bytes_of(World(two)), one);
  EXPECT_LT(bytes_of(World(two)), 4 * one);
}

}  // namespace
}  // namespace rayfarm
