// What is expected to end last, and who does it again.
#include "master/tail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace rayfarm {
namespace {

TEST(Tail, WorkThatWasBegunLacksWhatIsExpectedLessWhatItTookAlready) {
  EXPECT_EQ(times_left(std::vector<HeldWork>{{5, 2}, {5, 4}}, 2), (std::vector<double>{3, 1}));
}

TEST(Tail, WhatIsLateIsExpectedToBeLateByAsMuchAgain) {
  EXPECT_EQ(times_left(std::vector<HeldWork>{{5, 12}}, 1), (std::vector<double>{7}));
}

TEST(Tail, WhatWaitsIsBegunByTheThreadThatIsFreeFirst) {
  EXPECT_EQ(times_left(std::vector<HeldWork>{{5, 2}, {5, 4}, {10, {}}, {10, {}}, {1, {}}}, 2),
            (std::vector<double>{3, 1, 11, 13, 12}));
}

TEST(Tail, AThreadThatHasNothingTakesWhatWaitsAtOnce) {
  EXPECT_EQ(times_left(std::vector<HeldWork>{{5, 2}, {4, {}}}, 3), (std::vector<double>{3, 4}));
}

TEST(Tail, WhoTakesTwentyTimesAsLongIsNotWaitedFor) {
  EXPECT_FALSE(is_stuck({.expected = 1}));
  EXPECT_FALSE(is_stuck({.expected = 1, .spent = 20}));
  EXPECT_TRUE(is_stuck({.expected = 1, .spent = 20.1}));
  EXPECT_FALSE(is_stuck({.expected = 0.001, .spent = 1.9})) << "who is silent is lost within 2 s";
  EXPECT_TRUE(is_stuck({.expected = 0.001, .spent = 2.1}));
}

TEST(Tail, WhatNothingIsKnownOfTakesHalfASecond) {
  EXPECT_EQ(expected_seconds(0, 100), 0.5);
  EXPECT_EQ(expected_seconds(100, 0), 0.5);
  EXPECT_EQ(expected_seconds(100, 50), 2);
}

TEST(Tail, WhatEndsLastIsDoubledFirstByTheFastest) {
  const std::vector<Straggler> stragglers{{1, 3, 100}, {1, 9, 100}, {1, 6, 100}};
  const std::vector<IdleWorker> idle{{2, 50, 1}, {3, 100, 1}};
  EXPECT_EQ(copies_of(stragglers, idle), (std::vector<Copy>{{1, 1}, {2, 0}}));
}

TEST(Tail, NothingIsDoubledThatItsHolderWouldEndSooner) {
  const std::vector<IdleWorker> idle{{2, 50, 4}};
  EXPECT_TRUE(copies_of(std::vector<Straggler>{{1, 1.9, 100}}, idle).empty());
  EXPECT_EQ(copies_of(std::vector<Straggler>{{1, 2.1, 100}}, idle).size(), 1u);
}

TEST(Tail, TwoWorkersOfTheSameSpeedDoNotDoubleEachOthersWork) {
  const std::vector<double> left = times_left(std::vector<HeldWork>{{2, 0.0}}, 1);
  EXPECT_TRUE(
      copies_of(std::vector<Straggler>{{1, left[0], 100}}, std::vector<IdleWorker>{{2, 50, 1}}).empty());
}

TEST(Tail, ASlowTileDoesNotKeepTheSmallerOnesFromBeingDoubled) {
  const std::vector<Straggler> stragglers{{1, 9, 1000}, {1, 8, 10}};
  EXPECT_EQ(copies_of(stragglers, std::vector<IdleWorker>{{2, 50, 1}}), (std::vector<Copy>{{1, 0}}));
}

TEST(Tail, AWorkerIsFreeWhenTheFirstOfItsThreadsHasNothingMoreToDo) {
  EXPECT_EQ(time_until_free({}, 2), 0);
  EXPECT_EQ(time_until_free({3}, 2), 0);
  EXPECT_EQ(time_until_free({3, 1}, 2), 1);
  EXPECT_EQ(time_until_free({3, 1, 11, 13, 12}, 2), 12);
}

TEST(Tail, AFastWorkerThatIsBusyTooLongLeavesItToASlowerOne) {
  const std::vector<Straggler> stragglers{{1, 5, 100}};
  EXPECT_EQ(copies_of(stragglers, std::vector<IdleWorker>{{2, 100, 1, 4.5}, {3, 50, 1, 0}}),
            (std::vector<Copy>{{0, 1}}));
  EXPECT_EQ(copies_of(stragglers, std::vector<IdleWorker>{{2, 100, 1, 3.5}, {3, 50, 1, 0}}),
            (std::vector<Copy>{{0, 0}}));
}

TEST(Tail, APieceGoesToOneThatTakesPieces) {
  const IdleWorker old{.id = 2, .speed = 100, .threads = 1, .takes_pieces = false}, young{3, 50, 1};
  EXPECT_EQ(copies_of(std::vector<Straggler>{{1, 5, 100, {}, true}}, std::vector{old, young}),
            (std::vector<Copy>{{0, 1}}));
  EXPECT_EQ(copies_of(std::vector<Straggler>{{1, 5, 100, {}, false}}, std::vector{old, young}),
            (std::vector<Copy>{{0, 0}}));
}

TEST(Tail, WhateverTheNumbersEachWorkIsDoubledOnceAtMostByAnotherThatIsSoonerAndHasAThread) {
  std::mt19937 random(7);
  const auto chance = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int round = 0; round < 2000; ++round) {
    std::vector<Straggler> stragglers;
    std::vector<IdleWorker> idle;
    for (int i = chance(12); i > 0; --i)
      stragglers.push_back({static_cast<std::uint64_t>(chance(5)), 0.1 * chance(100), 10.0 * chance(20)});
    for (int i = 0; i < chance(6); ++i)
      idle.push_back({static_cast<std::uint64_t>(i), 10.0 * chance(20), static_cast<std::uint32_t>(chance(3)),
                      0.1 * chance(30)});

    const std::vector<Copy> copies = copies_of(stragglers, idle);
    std::set<std::size_t> doubled;
    for (const Copy& copy : copies) {
      EXPECT_TRUE(doubled.insert(copy.straggler).second);
      EXPECT_NE(stragglers[copy.straggler].holder, idle[copy.worker].id);
      EXPECT_LT(
          idle[copy.worker].busy + expected_seconds(stragglers[copy.straggler].cost, idle[copy.worker].speed),
          stragglers[copy.straggler].time_left);
    }
    for (std::size_t w = 0; w < idle.size(); ++w)
      EXPECT_LE(std::ranges::count(copies, w, &Copy::worker), idle[w].threads);
    const auto ends_later = [&](const Copy& a, const Copy& b) {
      return stragglers[a.straggler].time_left > stragglers[b.straggler].time_left;
    };
    EXPECT_TRUE(std::ranges::is_sorted(copies, ends_later));
  }
}

}  // namespace
}  // namespace rayfarm
