// A farm that is built again from what it recorded. See chance_test.cpp for the law under chance.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "tests/master/farm/fake_worker.h"
#include "tests/master/farm/rebuilt_farm.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size four_tiles{128, 128};

/// A farm with a job, of which a worker has done so many tiles; and that farm again.
struct TwoLives {
  explicit TwoLives(int tiles, JobSpec spec = job_of(four_tiles)) : job(first.submit(std::move(spec), 1s)) {
    FakeWorker pc(first, {.name = "pc", .threads = 2}, 1s);
    for (int i = 0; i < tiles; ++i) pc.finish_one(2s);
    records = first.take_records();
  }
  Farm& again() { return second.emplace(FarmLimits{}, past_of(records), 3s); }
  /// The commit's pixels can no longer be read.
  void damage(int commit) {
    for (FarmRecord& record : records)
      if (auto* tile = std::get_if<TileCommitted>(&record.fact); tile && commit-- == 0) tile->images.clear();
  }

  Farm first;
  JobId job;
  std::vector<FarmRecord> records;
  std::optional<Farm> second;
};

TEST(FarmBuiltAgain, GivesOutWhatWasLeasedAndNothingThatWasCommitted) {
  TwoLives lives(2);
  FakeWorker pc(lives.again(), {.name = "pc", .threads = 8}, 3s);
  ASSERT_EQ(pc.held().size(), 2u);
  for (const Assignment& given : pc.held()) EXPECT_EQ(lives.first.film(lives.job)->passes_of(given.tile), 0);
  pc.finish_all(4s);
  EXPECT_EQ(lives.second->job(lives.job, 4s)->state, JobState::done);
  EXPECT_EQ(lives.second->film(lives.job)->rgb(), made_up_picture(lives.job, four_tiles));
}

TEST(FarmBuiltAgain, GoesOnRecordingWhereItEnded) {
  TwoLives lives(2);
  Farm& again = lives.again();
  EXPECT_TRUE(again.take_records().empty());
  FakeWorker(again, {.name = "other", .threads = 8}, 3s).finish_all(4s);
  std::vector<FarmRecord> records = lives.records;
  std::ranges::move(again.take_records(), std::back_inserter(records));
  expect_same(again, Farm({}, past_of(records), 5s), 5s);
}

TEST(FarmBuiltAgain, NumbersItsLeasesInAnotherWay) {
  TwoLives lives(2);
  FakeWorker pc(lives.again(), {.name = "another"}, 3s);
  ASSERT_FALSE(pc.held().empty());
  const Assignment given = pc.held().front();
  EXPECT_GT(given.lease, LeaseId{1u << 31});
  // One of the last life does for none of this one.
  Result late = rendered(given, four_tiles);
  late.lease = LeaseId{3};
  EXPECT_THROW(lives.second->receive(pc.id(), late, 4s), WorkerError);
  EXPECT_EQ(lives.second->job(lives.job, 4s)->pixels_done, 2 * 64u * 64u);
}

TEST(FarmBuiltAgain, KnowsWhoIsDrainedAndWhoIsBanned) {
  Farm farm;
  for (const char* name : {"a", "b", "c"}) FakeWorker(farm, {.name = name});
  farm.drain("a", 1s), farm.ban("b", 1s);
  const std::vector<FarmRecord> records = farm.take_records();
  Farm again({}, past_of(records), 2s);
  EXPECT_EQ(again.banned(), std::vector<std::string>{"b"});
  EXPECT_TRUE(again.objection_to("b"));
  EXPECT_TRUE(again.ban("c", 2s)) << "who was here once can be banned";
  const FakeWorker a(again, {.name = "a"}, 2s);
  EXPECT_EQ(again.workers().front().state, WorkerState::drained);
}

TEST(FarmBuiltAgain, DoesNotUseAJobsNumberAgain) {
  Farm farm(FarmLimits{.jobs = 1});
  const JobId first = farm.submit(job_of(four_tiles), 0s), last = farm.submit(job_of(four_tiles), 0s);
  farm.cancel(last, 1s), farm.cancel(first, 2s);
  ASSERT_FALSE(farm.job(last, 2s)) << "of those that ended only the newest is kept";
  const std::vector<FarmRecord> records = farm.take_records();
  Farm again(FarmLimits{.jobs = 1}, past_of(records), 3s);
  expect_same(farm, again, 3s);
  EXPECT_GT(again.submit(job_of(four_tiles), 3s), last);
}

TEST(FarmBuiltAgain, DropsWhatBecameTooOldMeanwhileAndRemembersWhatWasRemoved) {
  Farm farm;
  FakeWorker pc(farm, {.name = "pc"});
  const JobId old = farm.submit(job_of(four_tiles), 0s), removed = farm.submit(job_of(four_tiles), 0s);
  const JobId young = farm.submit(job_of(four_tiles), 0s);
  for (const auto end : {1s, 2s, 3s})
    for (int tile = 0; tile < 4; ++tile) pc.finish_one(end);
  ASSERT_TRUE(farm.remove(removed));
  std::vector<FarmRecord> records = farm.take_records();
  const FarmLimits limits{.job_age = 10s};
  Farm again(limits, past_of(records), 12s);
  EXPECT_FALSE(again.job(old, 12s));
  EXPECT_TRUE(again.was_here(old));
  EXPECT_TRUE(again.was_here(removed));
  EXPECT_EQ(again.film(young)->rgb(), made_up_picture(young, four_tiles));
  std::ranges::move(again.take_records(), std::back_inserter(records));
  expect_same(again, Farm({}, past_of(records), 12s), 12s);
}

TEST(FarmBuiltAgain, PausesAJobWhosePixelsAreDamagedAndRendersThemWhenItIsResumed) {
  for (const int tiles : {2, 4}) {
    SCOPED_TRACE(tiles);
    TwoLives lives(tiles);
    lives.damage(1);
    Farm& again = lives.again();
    EXPECT_EQ(again.film(lives.job)->pixels_done(), (tiles - 1) * 64u * 64u);
    const JobView job = again.job(lives.job, 3s).value();
    EXPECT_EQ(job.state, JobState::paused);
    EXPECT_EQ(job.pixels_done, (tiles - 1) * 64u * 64u);
    EXPECT_NE(job.message.find("1 tile of its picture was damaged"), std::string::npos) << job.message;

    std::vector<FarmRecord> records = lives.records;
    std::ranges::move(again.take_records(), std::back_inserter(records));
    expect_same(again, Farm({}, past_of(records), 3s), 3s);

    ASSERT_TRUE(again.resume(lives.job, 4s));
    FakeWorker pc(again, {.name = "pc", .threads = 8}, 4s);
    EXPECT_EQ(pc.held().size(), 5u - tiles);
    pc.finish_all(5s);
    EXPECT_EQ(again.job(lives.job, 5s)->state, JobState::done);
    EXPECT_EQ(again.job(lives.job, 5s)->message, "");
    EXPECT_EQ(again.job(lives.job, 5s)->counters, made_up_counters(four_tiles));
    EXPECT_EQ(again.film(lives.job)->rgb(), made_up_picture(lives.job, four_tiles));
  }
}

TEST(FarmBuiltAgain, PausesAJobOfWhichRecordsAreMissing) {
  TwoLives lives(4);
  const auto is_commit = [](const FarmRecord& record) {
    return std::holds_alternative<TileCommitted>(record.fact);
  };
  lives.records.erase(std::ranges::find_if(lives.records, is_commit));
  Farm& again = lives.again();
  EXPECT_EQ(again.job(lives.job, 3s)->state, JobState::paused);
  again.resume(lives.job, 4s);
  FakeWorker pc(again, {.name = "pc"}, 4s);
  pc.finish_all(5s);
  EXPECT_EQ(again.job(lives.job, 5s)->state, JobState::done);
  EXPECT_EQ(again.film(lives.job)->rgb(), made_up_picture(lives.job, four_tiles));
}

TEST(FarmBuiltAgain, PausesAJobWhosePixelsCannotBeReadNow) {
  TwoLives lives(2);
  bool is_there = false;
  FarmPast past = past_of(lives.records);
  past.read_pixels = [&, read = past.read_pixels](FrameId frame, const auto& put) {
    if (!is_there) throw std::runtime_error("no such disk");
    read(frame, put);
  };
  Farm again({}, std::move(past), 3s);
  const FakeWorker pc(again, {.name = "pc"}, 3s);
  EXPECT_TRUE(pc.held().empty());
  EXPECT_EQ(again.job(lives.job, 3s)->state, JobState::paused);
  EXPECT_NE(again.job(lives.job, 3s)->message.find("no such disk"), std::string::npos);
  EXPECT_EQ(again.film(lives.job), nullptr);
  is_there = true;
  again.resume(lives.job, 4s);
  EXPECT_FALSE(pc.held().empty());
  EXPECT_EQ(again.film(lives.job)->pixels_done(), 2 * 64u * 64u);
}

TEST(FarmBuiltAgain, FailsAJobWhoseSceneIsDamaged) {
  TwoLives lives(2);
  for (FarmRecord& record : lives.records)
    if (auto* added = std::get_if<FrameAdded>(&record.fact)) added->scene = nullptr;
  Farm& again = lives.again();
  EXPECT_EQ(again.job(lives.job, 3s)->state, JobState::failed);
  EXPECT_NE(again.job(lives.job, 3s)->message.find("submit it again"), std::string::npos);
  EXPECT_EQ(again.film(lives.job)->pixels_done(), 2 * 64u * 64u) << "what is there can be fetched";
}

}  // namespace
}  // namespace rayfarm
