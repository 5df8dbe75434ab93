#include "master/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rayfarm {
namespace {

constexpr Size five_by_three{5 * 64, 3 * 64};

std::vector<Work> all_tiles_taken_from(Schedule& schedule) {
  std::vector<Work> taken;
  while (const auto work = schedule.take_tile()) taken.push_back(*work);
  return taken;
}

TEST(Schedule, AWorkerTakesWholeTilesCentreFirst) {
  Schedule schedule(five_by_three);
  std::vector<Work> expected;
  for (const std::uint32_t tile : centre_first(five_by_three)) expected.push_back({tile, all_passes});
  EXPECT_EQ(all_tiles_taken_from(schedule), expected);
  EXPECT_FALSE(schedule.has_waiting());
}

TEST(Schedule, ALocalThreadTakesCoarsePassesOfTheWholePictureFirst) {
  Schedule schedule(five_by_three);
  for (int pass = 0; pass < pass_count; ++pass)
    for (const std::uint32_t tile : centre_first(five_by_three))
      EXPECT_EQ(schedule.take_pass(), (Work{tile, static_cast<PassSet>(1 << pass)}));
  EXPECT_EQ(schedule.take_pass(), std::nullopt);
}

TEST(Schedule, AWorkerTakesOnlyThePassesNotThereYet) {
  Schedule schedule(five_by_three);
  const Work coarse = schedule.take_pass().value();
  const Work leased = schedule.take_pass().value();
  schedule.finish(coarse);
  for (const Work& work : all_tiles_taken_from(schedule)) {
    const bool lacks_coarse = work.tile == coarse.tile || work.tile == leased.tile;
    EXPECT_EQ(work.passes, lacks_coarse ? all_passes & ~1 : all_passes);
  }
}

TEST(Schedule, WhatWasGivenBackGoesFirst) {
  Schedule schedule(five_by_three);
  const Work first = schedule.take_tile().value(), second = schedule.take_tile().value();
  schedule.take_tile();
  schedule.give_back(second);
  schedule.give_back(first);
  EXPECT_EQ(schedule.take_tile(), first);
  EXPECT_EQ(schedule.take_tile(), second);
}

TEST(Schedule, ALocalThreadPrefersCoarseOverGivenBack) {
  Schedule schedule(five_by_three);
  const Work whole = schedule.take_tile().value();
  schedule.give_back({whole.tile, 0b1000});
  EXPECT_EQ(schedule.take_pass()->passes, 0b0001);
  while (schedule.waiting(centre_first(five_by_three).back()) & 0b0100) schedule.take_pass();
  EXPECT_EQ(schedule.take_pass(), (Work{whole.tile, 0b1000}));
}

TEST(Schedule, PassesWithoutPixelsAreNeverGivenOut) {
  Schedule schedule({65, 1});  // its second tile is one pixel
  const std::vector<Work> taken = all_tiles_taken_from(schedule);
  EXPECT_EQ(taken, (std::vector<Work>{{0, all_passes}, {1, 0b0001}}));
  EXPECT_EQ(schedule.done(1), 0b1110);
}

/// Drives a schedule by chance and keeps the same book by hand.
void check_partition_under_chance(Size film, unsigned seed) {
  std::mt19937 random(seed);
  const auto chance = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  Schedule schedule(film);
  std::vector<Work> leased;
  std::vector<PassSet> done(tile_count(film));
  for (std::uint32_t t = 0; t < done.size(); ++t) done[t] = schedule.done(t);

  while (schedule.has_waiting() || !leased.empty()) {
    if (leased.empty() || chance(2) == 0) {
      const auto work = chance(2) == 0 ? schedule.take_pass() : schedule.take_tile();
      if (work) leased.push_back(*work);
      ASSERT_EQ(work.has_value() || !schedule.has_waiting(), true);
    }
    if (!leased.empty() && chance(2) == 0) {
      std::swap(leased[chance(leased.size())], leased.back());
      if (chance(3) == 0) {
        schedule.give_back(leased.back());
      } else {
        schedule.finish(leased.back());
        done[leased.back().tile] |= leased.back().passes;
      }
      leased.pop_back();
    }
    std::vector<PassSet> leased_in(done.size());
    for (const Work& work : leased) {
      ASSERT_EQ(leased_in[work.tile] & work.passes, 0) << "leased twice";
      leased_in[work.tile] |= work.passes;
    }
    bool any_waiting = false;
    for (std::uint32_t t = 0; t < done.size(); ++t) {
      ASSERT_EQ(schedule.done(t), done[t]);
      ASSERT_EQ(schedule.leased(t), leased_in[t]);
      ASSERT_EQ(schedule.waiting(t), all_passes & ~(done[t] | leased_in[t]));
      any_waiting |= schedule.waiting(t) != 0;
    }
    ASSERT_EQ(schedule.has_waiting(), any_waiting);
  }
  EXPECT_TRUE(std::ranges::all_of(done, [](PassSet passes) { return passes == all_passes; }));
}

// A farm that was built again from a commit, its loss and another commit had given the tile out once more, and died.
TEST(Schedule, WhatWasLostAndDoneAgainWaitsNoMore) {
  Schedule schedule({128, 64});
  const Work work{0, all_passes};
  schedule.set_done(work);
  schedule.undo(work);
  schedule.set_done(work);
  EXPECT_EQ(schedule.take_tile()->tile, 1u);
  EXPECT_FALSE(schedule.take_tile());
  EXPECT_FALSE(schedule.take_pass());
}

TEST(Schedule, EachPassOfEachTileIsWaitingLeasedOrDoneWhateverHappens) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    check_partition_under_chance({300, 200}, seed);
    check_partition_under_chance({129, 65}, seed);
    check_partition_under_chance({1, 1}, seed);
  }
}

}  // namespace
}  // namespace rayfarm
