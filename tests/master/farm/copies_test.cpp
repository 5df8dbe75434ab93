// The tail: work that is done a second time by threads that would idle.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size four_tiles{4 * 64, 64};

WorkerInfo remote(std::string name, std::uint32_t threads = 1) {
  return {.name = std::move(name), .threads = threads};
}

/// A slow worker holds the last tile, and a fast one has just become idle.
struct Tail {
  Farm farm;
  FakeWorker fast{farm, remote("fast")};
  JobId job = farm.submit(job_of(four_tiles), 0s);
  FakeWorker slow{farm, remote("slow")};

  Tail() {
    fast.finish_one(1s, 1);  // a second for a tile
    while (!fast.held().empty()) fast.finish_one(2s, 1);
    farm.take_events();
  }
  JobView view(FarmTime now) const { return *farm.job(job, now); }
};

TEST(Copies, AnIdleWorkerDoublesWhatASlowOneHolds) {
  Tail tail;
  ASSERT_EQ(tail.slow.held().size(), 1u);
  EXPECT_TRUE(tail.fast.held().empty()) << "as far as is known the other will be no later";
  tail.farm.tick(3s);
  ASSERT_EQ(tail.fast.held().size(), 1u) << "it is late by more than the copy takes";
  EXPECT_EQ(tail.fast.held()[0].tile, tail.slow.held()[0].tile);
  EXPECT_EQ(tail.fast.held()[0].passes, tail.slow.held()[0].passes);
  EXPECT_NE(tail.fast.held()[0].lease, tail.slow.held()[0].lease);
  EXPECT_EQ(tail.view(3s).tiles_doubled, 1u);
}

TEST(Copies, TheFirstResultIsTakenAndTheOtherLeaseEnds) {
  for (const bool copy_is_first : {true, false}) {
    Tail tail;
    tail.farm.tick(3s);
    (copy_is_first ? tail.fast : tail.slow).finish_one(5s, 1);
    EXPECT_TRUE(tail.fast.held().empty());
    EXPECT_TRUE(tail.slow.held().empty());
    EXPECT_EQ(tail.view(5s).state, JobState::done);
    EXPECT_EQ(tail.view(5s).counters, made_up_counters(four_tiles));
    EXPECT_EQ(tail.farm.film(tail.job)->rgb(), made_up_picture(tail.job, four_tiles));
    EXPECT_EQ(tail.view(5s).time_wasted, copy_is_first ? 5s : 2s) << "since the loser had begun";
    EXPECT_EQ(tail.view(5s).tiles_given_back, 0u);
  }
}

TEST(Copies, ALoserThatCouldNotBeStoppedInTimeIsComparedAndNoMismatch) {
  Tail tail;
  tail.farm.tick(3s);
  const Assignment lost = tail.slow.held().at(0);
  tail.fast.finish_one(4s, 1);
  tail.farm.receive(tail.slow.id(), rendered(lost, four_tiles), 4s);
  EXPECT_EQ(tail.view(4s).counters, made_up_counters(four_tiles));
  for (const FarmEvent& event : tail.farm.take_events()) EXPECT_FALSE(event.warning) << event.text;
}

TEST(Copies, ThereAreTwoAtMostAndNeverTwoWithOneWorker) {
  Tail tail;
  FakeWorker third(tail.farm, remote("third"), 2s);
  for (int i = 0; i < 100; ++i) tail.farm.tick(3s + i * 100ms);
  EXPECT_EQ(tail.fast.held().size() + third.held().size(), 1u);
  EXPECT_EQ(tail.slow.held().size(), 1u);
}

TEST(Copies, WhenOneOfTwoIsLostTheOtherGoesOn) {
  for (const bool copy_is_lost : {true, false}) {
    Tail tail;
    tail.farm.tick(3s);
    FakeWorker& lost = copy_is_lost ? tail.fast : tail.slow;
    FakeWorker& other = copy_is_lost ? tail.slow : tail.fast;
    tail.farm.remove_worker(lost.id(), "gone", 4s);
    EXPECT_EQ(other.held().size(), 1u);
    other.finish_one(5s, 1);
    EXPECT_EQ(tail.view(5s).state, JobState::done);
    EXPECT_EQ(tail.view(5s).tiles_given_back, 1u);
  }
}

TEST(Copies, WhenBothAreLostTheTileWaitsOnce) {
  Tail tail;
  tail.farm.tick(3s);
  tail.farm.remove_worker(tail.fast.id(), "gone", 4s);
  tail.farm.remove_worker(tail.slow.id(), "gone", 4s);
  FakeWorker next(tail.farm, remote("next", 4), 4s);
  EXPECT_EQ(next.held().size(), 1u);
  next.finish_all(5s);
  EXPECT_EQ(tail.view(5s).counters, made_up_counters(four_tiles));
}

TEST(Copies, PausingEndsBothAndResumingGivesOneTile) {
  Tail tail;
  tail.farm.tick(3s);
  tail.farm.pause(tail.job, 4s);
  EXPECT_TRUE(tail.fast.held().empty());
  EXPECT_TRUE(tail.slow.held().empty());
  tail.farm.resume(tail.job, 5s);
  EXPECT_EQ(tail.fast.held().size() + tail.slow.held().size(), 1u);
}

TEST(Copies, WhatWouldEndAfterAllTheRestIsDoubledBeforeThatIsDone) {
  Farm farm;
  FakeWorker fast(farm, remote("fast")), slow(farm, remote("slow"));
  const JobId job = farm.submit(job_of({30 * 64, 64}), 0s);
  slow.finish_one(1s, 1);  // looks as fast as the other, and is not
  FarmTime now = 1s;
  while (fast.held().back().tile != slow.held().front().tile) {
    fast.finish_one(now += 1s, 1);
    farm.tick(now);
    ASSERT_LT(now, 30s);
  }
  EXPECT_LT(now, 25s) << "when some 29 tiles were left to the fast one";
  EXPECT_GT(farm.job(job, now)->tiles_doubled, 0u);
}

TEST(Copies, NothingIsDoubledWhileMuchWaits) {
  Farm farm;
  FakeWorker fast(farm, remote("fast")), slow(farm, remote("slow"));
  const JobId job = farm.submit(job_of({100 * 64, 64}), 0s);
  for (int i = 1; i <= 50; ++i) {
    fast.finish_one(i * 1s, 1);
    farm.tick(i * 1s);
  }
  EXPECT_EQ(farm.job(job, 50s)->tiles_doubled, 0u);
}

TEST(Copies, ATileThatWaitsForAThreadOfASlowWorkerIsDoneByAnIdleOneAndWastesNothing) {
  Farm farm;
  const JobId job = farm.submit(job_of({16 * 64, 64}), 0s);
  FakeWorker slow(farm, remote("slow"));
  slow.finish_one(10s, 10);
  ASSERT_EQ(slow.held().size(), 3u);
  FakeWorker fast(farm, remote("fast"), 10s);
  FarmTime now = 10s;
  while (farm.job(job, now)->state != JobState::done) {
    now += 1s;
    if (!fast.held().empty()) fast.finish_one(now, 1);
    farm.tick(now);
    ASSERT_LT(now, 60s);
  }
  EXPECT_LE(now, 27s) << "the slow worker alone would be at 40 s, or beyond";
  EXPECT_LE(farm.job(job, now)->time_wasted, now - 10s) << "one thread was busy in vain, no more";
  EXPECT_EQ(farm.job(job, now)->counters, made_up_counters({16 * 64, 64}));
}

TEST(Copies, AWorkerThatRefusesTheJobIsGivenNone) {
  Tail tail;
  FakeWorker small(tail.farm, remote("small", 4), 2s);
  tail.farm.tick(2s);
  tail.farm.tick(3s);
  FakeWorker& holder = tail.fast.held().empty() ? small : tail.fast;
  const LeaseId copy = holder.held().at(0).lease;
  holder.drop(copy);
  tail.farm.receive(holder.id(), GiveBack{{copy}, "out of memory"}, 3s);
  for (int i = 0; i < 20; ++i) tail.farm.tick(4s + i * 100ms);
  EXPECT_TRUE(holder.held().empty());
}

}  // namespace
}  // namespace rayfarm
