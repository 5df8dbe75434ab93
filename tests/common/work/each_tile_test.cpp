#include "common/work/each_tile.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <stdexcept>

namespace rayfarm {
namespace {

const auto unheard = [] {};

TEST(EachTile, EachIsDoneOnceByAnyNumberOfThreads) {
  const Size film{200, 130};
  for (const unsigned threads : {1u, 3u, 40u}) {
    std::mutex mutex;
    std::vector<int> times(tile_count(film));
    EXPECT_TRUE(each_tile(
        film, threads,
        [&](std::uint32_t tile) {
          const std::lock_guard lock(mutex);
          ++times[tile];
          return true;
        },
        unheard));
    EXPECT_EQ(times, std::vector<int>(tile_count(film), 1));
  }
}

TEST(EachTile, AFalseEndsIt) {
  std::atomic<int> calls{0};
  EXPECT_FALSE(each_tile(
      {640, 640}, 1, [&](std::uint32_t) { return ++calls < 3; }, unheard));
  EXPECT_EQ(calls, 3);
}

TEST(EachTile, WhatWorkThrowsIsThrown) {
  const auto work = [](std::uint32_t) -> bool { throw std::runtime_error("out of paint"); };
  EXPECT_THROW(each_tile({640, 640}, 2, work, unheard), std::runtime_error);
}

}  // namespace
}  // namespace rayfarm
