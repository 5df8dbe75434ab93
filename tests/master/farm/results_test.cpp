// Results that are late or wrong, and work that workers will not do.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size four_tiles{128, 128};

WorkerInfo remote(std::string name) { return {.name = std::move(name), .threads = 4}; }

std::vector<std::string> warnings_of(Farm& farm) {
  std::vector<std::string> warnings;
  for (const FarmEvent& event : farm.take_events())
    if (event.warning) warnings.push_back(event.text);
  return warnings;
}

/// A worker of whom the job was taken and given to another, who finished it.
struct LateWorker {
  Farm farm;
  FakeWorker late{farm, remote("late")};
  JobId job = farm.submit(job_of(four_tiles), 0s);
  Assignment revoked = late.held().at(0);
  std::vector<Assignment> others{late.held().begin() + 1, late.held().end()};  // revoked, too
  FakeWorker other{farm, remote("other")};

  LateWorker() {
    farm.drain("late", 0s);
    other.finish_all();
    farm.take_events();
  }
};

TEST(Farm, ALateTwinWithTheSamePixelsIsDroppedSilently) {
  LateWorker scene;
  const std::uint64_t rays = scene.farm.job(scene.job, 0s)->counters.rays();
  scene.farm.receive(scene.late.id(), rendered(scene.revoked, four_tiles), 1s);
  EXPECT_TRUE(scene.farm.take_events().empty());
  EXPECT_EQ(scene.farm.job(scene.job, 0s)->counters.rays(), rays);
  EXPECT_EQ(scene.farm.film(scene.job)->rgb(), made_up_picture(scene.job, four_tiles));
}

TEST(Farm, ALateTwinWithOtherPixelsIsAWarningThatNamesBoth) {
  LateWorker scene;
  Result twin = rendered(scene.revoked, four_tiles);
  twin.images[2].rgb[5] = -twin.images[2].rgb[5];
  scene.farm.receive(scene.late.id(), twin, 1s);
  const std::vector<std::string> warnings = warnings_of(scene.farm);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("late"), std::string::npos);
  EXPECT_NE(warnings[0].find("other"), std::string::npos);
  EXPECT_EQ(scene.farm.film(scene.job)->rgb(), made_up_picture(scene.job, four_tiles));
  twin = rendered(scene.others.at(0), four_tiles);
  twin.images[2].rgb[5] = -twin.images[2].rgb[5];
  scene.farm.receive(scene.late.id(), twin, 1s);
  EXPECT_TRUE(warnings_of(scene.farm).empty()) << "no floods";
}

TEST(Farm, ARevokedLeaseCommitsNothing) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  const JobId job = farm.submit(job_of(four_tiles), 0s);
  const Assignment revoked = worker.held().at(0);
  farm.pause(job, 0s);
  farm.receive(worker.id(), rendered(revoked, four_tiles), 1s);
  EXPECT_EQ(farm.film(job)->pixels_done(), 0u);
  farm.resume(job, 2s);
  worker.finish_all();
  EXPECT_EQ(farm.film(job)->rgb(), made_up_picture(job, four_tiles));
}

TEST(Farm, ALeaseIsGoodForOneResult) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  const JobId job = farm.submit(job_of(four_tiles), 0s);
  const Result result = rendered(worker.held().at(0), four_tiles);
  worker.finish_one();
  EXPECT_EQ(farm.film(job)->pixels_done(), 64u * 64u);
  EXPECT_THROW(farm.receive(worker.id(), result, 1s), WorkerError);
  EXPECT_EQ(farm.workers().at(0).tiles, 1u);
}

TEST(Farm, AnothersLeaseCommitsNothing) {
  Farm farm;
  FakeWorker holder(farm, remote("holder")), thief(farm, remote("thief"));
  const JobId job = farm.submit(job_of(four_tiles), 0s);
  EXPECT_THROW(farm.receive(thief.id(), rendered(holder.held().at(0), four_tiles), 1s), WorkerError);
  EXPECT_EQ(farm.film(job)->pixels_done(), 0u);
}

TEST(Farm, AWrongResultThrowsCommitsNothingAndEndsTheLease) {
  const std::vector<std::function<void(Result&)>> lies{
      [](Result& r) { r.job = JobId{2}; },
      [](Result& r) { r.job = JobId{77}; },
      [](Result& r) { r.frame = 1; },
      [](Result& r) { r.tile ^= 1; },
      [](Result& r) { r.tile = 1'000'000; },
      [](Result& r) { r.images.clear(); },
      [](Result& r) { r.images.pop_back(); },
      [](Result& r) { r.images.push_back(r.images[0]); },
      [](Result& r) { r.images[1].pass = 0; },
      [](Result& r) { r.images[1].pass = 4; },
      [](Result& r) { r.images[1].pass = -1; },
      [](Result& r) { r.images[3].rgb.pop_back(); },
      [](Result& r) { r.images[3].rgb.push_back(0); },
      [](Result& r) { r.images[0].rgb.clear(); },
  };
  for (std::size_t i = 0; i < lies.size(); ++i) {
    Farm farm;
    FakeWorker liar(farm, remote("liar"));
    const JobId job = farm.submit(job_of(four_tiles), 0s);
    Result result = rendered(liar.held().at(0), four_tiles);
    lies[i](result);
    EXPECT_THROW(farm.receive(liar.id(), result, 1s), WorkerError) << "lie " << i;
    EXPECT_EQ(farm.film(job)->pixels_done(), 0u);
    EXPECT_EQ(farm.workers().at(0).leases, 3u);
    farm.remove_worker(liar.id(), "wrong result", 1s);
    FakeWorker honest(farm, remote("honest"));
    honest.finish_all();
    EXPECT_EQ(farm.film(job)->rgb(), made_up_picture(job, four_tiles));
  }
}

TEST(Farm, AResultForALeaseThatWasNeverGivenThrows) {
  LateWorker scene;
  Result result = rendered(scene.revoked, four_tiles);
  result.lease = LeaseId{1000};
  EXPECT_THROW(scene.farm.receive(scene.late.id(), result, 1s), WorkerError);
}

TEST(Farm, ALateResultIsCheckedAsWell) {
  LateWorker scene;
  Result result = rendered(scene.revoked, four_tiles);
  result.images[0].rgb.pop_back();
  EXPECT_THROW(scene.farm.receive(scene.late.id(), result, 1s), WorkerError);
  result = rendered(scene.others.at(0), four_tiles);
  result.tile = 4;
  EXPECT_THROW(scene.farm.receive(scene.late.id(), result, 1s), WorkerError);
}

TEST(Farm, AWorkerThatCannotRenderAJobIsNotOfferedItAgain) {
  Farm farm;
  FakeWorker small(farm, remote("small"));
  const JobId job = farm.submit(job_of({5 * 64, 64}), 0s);
  FakeWorker big(farm, remote("big"));
  const LeaseId one = small.held().at(0).lease;
  small.drop(one);
  farm.receive(small.id(), GiveBack{{one}, "out of memory"}, 1s);
  EXPECT_TRUE(small.held().empty()) << "its other leases of the job are revoked";
  EXPECT_EQ(big.held().size(), 4u);
  EXPECT_EQ(farm.job(job, 1s)->message, "worker small: out of memory");

  const JobId next = farm.submit(job_of(four_tiles), 1s);
  for (const Assignment& a : small.held()) EXPECT_EQ(a.job, next) << "other jobs are offered";
  EXPECT_EQ(small.held().size(), 4u);
  big.finish_all();
  EXPECT_EQ(farm.job(job, 2s)->state, JobState::done);
}

TEST(Farm, AJobThatEveryWorkerGaveBackHasFailed) {
  Farm farm;
  FakeWorker first(farm, remote("first")), second(farm, remote("second"));
  const JobId job = farm.submit(job_of(four_tiles), 0s);
  farm.receive(first.id(), GiveBack{{first.held().at(0).lease}, "out of memory"}, 1s);
  EXPECT_EQ(farm.job(job, 1s)->state, JobState::running);
  farm.receive(second.id(), GiveBack{{second.held().at(0).lease}, "out of memory"}, 1s);
  EXPECT_EQ(farm.job(job, 1s)->state, JobState::failed);
  EXPECT_EQ(farm.job(job, 1s)->message, "no worker can render it; worker second: out of memory");
  EXPECT_EQ(warnings_of(farm).size(), 1u);
}

// What it finished then was committed: a job that had failed was done, and its data were counted as freed twice.
TEST(Farm, AJobThatFailsTakesBackWhatAStoppingWorkerMightFinish) {
  Farm farm;
  FakeWorker stopping(farm, {.name = "stopping"});
  const JobId job = farm.submit(job_of({64, 64}), 0s);
  FakeWorker small(farm, {.name = "small"});
  FarmTime now{};
  while (small.held().empty()) farm.tick(now += 1s);  // it is given a copy
  const Assignment begun = stopping.held().at(0);
  farm.receive(stopping.id(), GiveBack{}, now);
  farm.receive(small.id(), GiveBack{{small.held()[0].lease}, "out of memory"}, now);
  ASSERT_EQ(farm.job(job, now)->state, JobState::failed);
  EXPECT_TRUE(stopping.held().empty());
  farm.receive(stopping.id(), rendered(begun, {64, 64}), now);
  EXPECT_EQ(farm.job(job, now)->state, JobState::failed);
  EXPECT_EQ(farm.job(job, now)->pixels_done, 0u);
}

TEST(Farm, AJobOfWhichSomethingIsDoneDoesNotFail) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  const JobId job = farm.submit(job_of(four_tiles), 0s);
  worker.finish_one();
  farm.receive(worker.id(), GiveBack{{worker.held().at(0).lease}, "out of memory"}, 1s);
  EXPECT_EQ(farm.job(job, 1s)->state, JobState::running);
  FakeWorker other(farm, remote("other"));
  other.finish_all();
  EXPECT_EQ(farm.job(job, 1s)->state, JobState::done);
}

TEST(Farm, AStoppingWorkerMayFinishWhatItHoldsAndGetsNothingMore) {
  Farm farm;
  FakeWorker leaving(farm, remote("leaving"));
  const JobId job = farm.submit(job_of({6 * 64, 64}), 0s);
  const std::vector<HeldAssignment> held = leaving.held();
  leaving.drop(held[2].lease), leaving.drop(held[3].lease);
  farm.receive(leaving.id(), GiveBack{{held[2].lease, held[3].lease}, ""}, 1s);
  leaving.finish_all();
  EXPECT_EQ(farm.film(job)->pixels_done(), 2u * 64u * 64u);
  farm.remove_worker(leaving.id(), "stopped", 1s);
  EXPECT_TRUE(warnings_of(farm).empty()) << "a clean stop is no warning";
  FakeWorker other(farm, remote("other"));
  other.finish_all();
  EXPECT_EQ(farm.job(job, 2s)->state, JobState::done);
}

TEST(Farm, GivingBackWhatWasRevokedMeanwhileIsNothing) {
  LateWorker scene;
  scene.farm.receive(scene.late.id(), GiveBack{{scene.revoked.lease, LeaseId{12345}}, "out of memory"}, 1s);
  EXPECT_TRUE(scene.farm.take_events().empty());
  EXPECT_EQ(scene.farm.job(scene.job, 1s)->state, JobState::done);
}

}  // namespace
}  // namespace rayfarm
