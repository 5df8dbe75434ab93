// Workers that deliver wrong pixels: how they are found, and that the picture is right in the end.
#include "master/verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "common/render/settings.h"
#include "tests/master/farm/liar.h"
#include "tests/master/farm/rebuilt_farm.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

// What is asked for. ---------------------------------------------------------------------------------------

TEST(Verification, IsReadAsItIsWritten) {
  for (const char* text : {"none", "audit=0.05", "audit=1", "audit=1e-06", "quorum=2", "quorum=16"})
    EXPECT_EQ(text_of(parse_verification(text)), text);
  for (const char* text : {"", "all", "audit", "audit=", "audit=0", "audit=-1", "audit=1.1", "audit=nan",
                           "audit=0.1x", "quorum=1", "quorum=17", "quorum=2.5", "quorum=-2"})
    EXPECT_THROW(parse_verification(text), SettingsError) << text;
}

TEST(Verification, IsPartOfWhatAKeyStandsFor) {
  Farm farm;
  JobSpec spec = verified(Quorum{2});
  spec.key = "k";
  const JobId job = farm.submit(spec, 0s);
  EXPECT_EQ(farm.submit(spec, 0s), job);
  spec.verification = Quorum{3};
  EXPECT_THROW(farm.submit(spec, 0s), KeyTaken);
}

TEST(Verification, NobodyIsAskedWithoutAndAsManyAsAQuorumHas) {
  EXPECT_EQ(opinions_wanted({}, {}, 0), 1u);
  EXPECT_EQ(opinions_wanted(Quorum{3}, {100, 0}, ~0ull), 3u);
}

TEST(Verification, AWorkerIsCheckedAlwaysUntilTenInARowWereRightAndThenAtTheShare) {
  for (std::uint32_t good = 0; good < 10; ++good)
    EXPECT_EQ(opinions_wanted(Audit{0.01}, {good, 0}, ~0ull), 2u);
  std::mt19937_64 random(1);
  int checked = 0;
  for (int i = 0; i < 100'000; ++i) checked += opinions_wanted(Audit{0.05}, {10, 0}, random()) == 2;
  EXPECT_NEAR(checked, 5000, 5 * std::sqrt(5000)) << "five standard deviations";
}

// Who lies. ------------------------------------------------------------------------------------------------

TEST(Verification, HonestWorkersAgreeAndAreTrusted) {
  Farm farm;
  FakeWorker a(farm, remote("a")), b(farm, remote("b"));
  const JobId job = farm.submit(verified(Audit{1}), 0s);
  FarmTime now = 0s;
  while (!a.held().empty() || !b.held().empty()) {
    now += 10ms;
    deliver_one(farm, a, now), deliver_one(farm, b, now);
  }
  expect_right_picture(farm, job, now);
  EXPECT_EQ(farm.job(job, now)->tiles_checked, 40u);
  EXPECT_EQ(farm.trust_in("a").good_in_a_row, 40u);
  EXPECT_EQ(farm.trust_in("b"), (Trust{40, 0}));
  EXPECT_TRUE(farm.banned().empty());
}

TEST(Verification, ALiarIsBannedAfterTwoWrongTilesWhateverItsLie) {
  for (const Lie& lie : {Lie(one_ulp), Lie(one_percent), Lie(anothers_tile)}) {
    Farm farm;
    FakeWorker liar(farm, remote("liar"));
    const JobId job = farm.submit(verified(Audit{0.01}), 0s);
    FakeWorker master(farm, masters_own());
    FarmTime now = 0s;
    while (!liar.held().empty() || !master.held().empty()) {
      now += 10ms;
      deliver_one(farm, liar, now, lie), deliver_one(farm, master, now);
    }
    EXPECT_TRUE(is_banned(farm, "liar"));
    expect_right_picture(farm, job, now);
    const std::optional<Deliveries> deliveries = farm.deliveries(job);
    for (const Deliveries::Tile& tile : deliveries->tiles)
      for (const std::uint32_t by : tile.by) EXPECT_NE(deliveries->names[by], "liar");
  }
}

TEST(Verification, PixelsThatAreNoNumbersAreALieInThemselves) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), infinite, -infinite}) {
    Farm farm;
    FakeWorker liar(farm, remote("liar"));
    farm.submit(job_of(forty_tiles), 0s);
    const auto lie = [value](Result& result) { result.images[1].rgb[7] = value; };
    EXPECT_THROW(deliver_one(farm, liar, 1s, lie), WorkerError);
    EXPECT_EQ(farm.film(JobId{1})->pixels_done(), 0u);
  }
}

TEST(Verification, AReplayedLeaseIsALie) {
  Farm farm;
  FakeWorker a(farm, remote("a")), b(farm, remote("b"));
  const JobId job = farm.submit(verified(Quorum{2}), 0s);
  Result replayed = rendered(a.held()[0], forty_tiles);
  deliver_one(farm, a, 1s);
  EXPECT_THROW(farm.receive(a.id(), replayed, 1s), WorkerError);
  EXPECT_EQ(farm.film(job)->pixels_done(), 0u) << "a worker has one opinion";
  EXPECT_EQ(farm.trust_in("a").mismatches, 1u);
}

TEST(Verification, OfThreeTheTwoWhoAgreeAreRight) {
  Farm farm;
  FakeWorker a(farm, remote("a")), liar(farm, remote("liar")), b(farm, remote("b"));
  const JobId job = farm.submit(verified(Quorum{2}), 0s);
  FarmTime now = 0s;
  while (!a.held().empty() || !b.held().empty() || !liar.held().empty()) {
    now += 10ms;
    deliver_one(farm, a, now), deliver_one(farm, liar, now, one_percent), deliver_one(farm, b, now);
  }
  EXPECT_EQ(farm.banned(), std::vector<std::string>{"liar"});
  expect_right_picture(farm, job, now);
}

TEST(Verification, AWorkerThatLiesOnceItIsTrustedIsCaughtAtTheShareAndAllItsTilesAreRenderedAgain) {
  constexpr double share = 0.1;
  constexpr int farms = 300;
  constexpr Size large{40 * 64, 10 * 64};
  double tiles = 0;
  for (int seed = 0; seed < farms; ++seed) {
    Farm farm({.secret = static_cast<std::uint64_t>(seed)});
    FakeWorker liar(farm, remote("liar", 1));
    const JobId job = farm.submit(verified(Audit{share}, large), 0s);
    FakeWorker master(farm, masters_own());
    FarmTime now = 0s;
    const auto step = [&](FakeWorker& worker, const Lie& lie) {
      const Assignment first = worker.held().at(0);
      worker.drop(first.lease);
      Result result = rendered(first, large);
      lie(result);
      farm.receive(worker.id(), result, now += 1s);
    };
    while (farm.trust_in("liar").good_in_a_row < 10) {
      if (!liar.held().empty()) step(liar, nothing);
      if (!master.held().empty()) step(master, nothing);
    }
    for (bool is_believed = true; is_believed; ++tiles) {
      const std::uint64_t before = farm.job(job, now)->pixels_done;
      step(liar, one_percent);
      is_believed = farm.job(job, now)->pixels_done > before;
      step(master, nothing);
    }
    if (seed >= 3) continue;  // the rest takes long
    while (farm.job(job, now)->state != JobState::done) {
      if (!liar.held().empty()) step(liar, one_percent);
      if (!master.held().empty()) step(master, nothing);
    }
    EXPECT_EQ(farm.film(job)->rgb(), made_up_picture(job, large));
    EXPECT_EQ(farm.job(job, now)->counters, made_up_counters(large));
    EXPECT_TRUE(is_banned(farm, "liar"));
  }
  // Geometric, with its standard deviation.
  EXPECT_NEAR(tiles / farms, 1 / share, 3 * std::sqrt(1 - share) / share / std::sqrt(farms));
}

// What happens meanwhile. ----------------------------------------------------------------------------------

TEST(Verification, WithoutASecondWorkerTilesWaitAndSaySo) {
  Farm farm;
  FakeWorker a(farm, remote("a"));
  const JobId job = farm.submit(verified(Quorum{2}), 0s);
  while (!a.held().empty()) deliver_one(farm, a, 1s);
  EXPECT_EQ(farm.job(job, 1s)->state, JobState::running);
  EXPECT_EQ(farm.job(job, 1s)->message, "tiles wait for another worker to check them");
  FakeWorker b(farm, remote("b"), 2s);
  while (!b.held().empty()) deliver_one(farm, b, 3s);
  expect_right_picture(farm, job, 3s);
  EXPECT_EQ(farm.job(job, 3s)->message, "");
}

TEST(Verification, AJudgeThatIsLostIsReplaced) {
  Farm farm;
  FakeWorker a(farm, remote("a"));
  const JobId job = farm.submit(verified(Quorum{2}), 0s);
  FakeWorker lost(farm, remote("lost"));
  deliver_one(farm, a, 1s);
  farm.remove_worker(lost.id(), "gone", 2s);
  FakeWorker b(farm, remote("b"), 2s);
  while (!a.held().empty() || !b.held().empty()) deliver_one(farm, a, 3s), deliver_one(farm, b, 3s);
  expect_right_picture(farm, job, 3s);
}

TEST(Verification, AJobThatIsCancelledOrPausedAsksNobody) {
  for (const bool is_cancelled : {true, false}) {
    Farm farm;
    FakeWorker a(farm, remote("a")), b(farm, remote("b"));
    const JobId job = farm.submit(verified(Quorum{2}), 0s);
    deliver_one(farm, a, 1s);
    is_cancelled ? farm.cancel(job, 1s) : farm.pause(job, 1s);
    EXPECT_TRUE(a.held().empty());
    EXPECT_TRUE(b.held().empty());
    if (is_cancelled) continue;
    farm.resume(job, 2s);
    while (!a.held().empty() || !b.held().empty()) deliver_one(farm, a, 3s), deliver_one(farm, b, 3s);
    expect_right_picture(farm, job, 3s);
  }
}

TEST(Verification, AFarmBuiltAgainKnowsWhomToTrustAndRendersAgainWhatWasOnTrial) {
  Farm first;
  FakeWorker a(first, remote("a")), b(first, remote("b"));
  const JobId job = first.submit(verified(Quorum{2}), 0s);
  for (int i = 0; i < 5; ++i) deliver_one(first, a, 1s);
  for (int i = 0; i < 3; ++i) deliver_one(first, b, 1s);
  const std::vector<FarmRecord> records = first.take_records();
  Farm farm({}, past_of(records), 2s);
  expect_same(first, farm, 2s);
  EXPECT_EQ(farm.trust_in("a"), first.trust_in("a"));
  EXPECT_EQ(farm.job(job, 2s)->verification, Verification(Quorum{2}));
  FakeWorker c(farm, remote("c")), d(farm, remote("d"));
  while (!c.held().empty() || !d.held().empty()) deliver_one(farm, c, 3s), deliver_one(farm, d, 3s);
  expect_right_picture(farm, job, 3s);
}

TEST(Verification, WhatALiarDeliveredForOtherUnfinishedJobsIsRenderedAgainToo) {
  Farm farm;
  FakeWorker liar(farm, remote("liar", 1));
  const JobId other = farm.submit(job_of(forty_tiles), 0s);
  FarmTime now = 0s;
  for (int i = 0; i < 10; ++i) deliver_one(farm, liar, now += 1s, one_percent);
  JobSpec spec = verified(Quorum{2});
  spec.priority = 90;
  const JobId job = farm.submit(spec, now);
  FakeWorker a(farm, remote("a"), now), b(farm, remote("b"), now);
  while (!a.held().empty() || !b.held().empty() || !liar.held().empty()) {
    now += 1s;
    deliver_one(farm, liar, now, one_percent);
    deliver_one(farm, a, now), deliver_one(farm, b, now);
  }
  EXPECT_TRUE(is_banned(farm, "liar"));
  expect_right_picture(farm, job, now);
  expect_right_picture(farm, other, now);
}

TEST(Verification, WhoeverComesAndGoesAndLiesThePictureIsRightInTheEnd) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto chance = [&](unsigned n) { return random() % n; };
    Farm farm({.secret = seed});
    const JobId job = farm.submit(chance(2) ? verified(Quorum{2}) : verified(Audit{1}), 0s);
    std::vector<FakeWorker> honest;
    std::optional<FakeWorker> liar;
    FarmTime now = 0s;
    int names = 0;
    while (farm.job(job, now)->state != JobState::done) {
      now += 10ms;
      farm.tick(now);
      if (honest.size() < 3) honest.emplace_back(farm, remote("pc" + std::to_string(names++)), now);
      if (!liar && !is_banned(farm, "liar")) liar.emplace(farm, remote("liar"), now);
      if (liar && is_banned(farm, "liar")) {
        farm.remove_worker(liar->id(), "refused", now);
        liar.reset();
      }
      if (liar) deliver_one(farm, *liar, now, chance(3) ? Lie(one_ulp) : Lie(nothing));
      FakeWorker& worker = honest[chance(static_cast<unsigned>(honest.size()))];
      deliver_one(farm, worker, now);
      if (chance(30) != 0) continue;
      farm.remove_worker(honest.back().id(), "gone", now);
      honest.pop_back();
    }
    expect_right_picture(farm, job, now);
  }
}

}  // namespace
}  // namespace rayfarm
