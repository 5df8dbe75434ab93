// What people are told: names, progress, time to go, events.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

WorkerInfo pc() { return {.name = "pc", .address = "10.0.0.7", .cpu = "Xeon", .threads = 2}; }

std::vector<std::string> texts_of(Farm& farm) {
  std::vector<std::string> texts;
  for (const FarmEvent& event : farm.take_events()) texts.push_back((event.warning ? "! " : "") + event.text);
  return texts;
}

TEST(Farm, WorkerNamesAreUniqueAndComeBack) {
  Farm farm;
  FakeWorker first(farm, pc()), second(farm, pc()), third(farm, pc()), nameless(farm, {});
  EXPECT_EQ(first.name(), "pc");
  EXPECT_EQ(second.name(), "pc-2");
  EXPECT_EQ(third.name(), "pc-3");
  EXPECT_EQ(nameless.name(), "worker");
  farm.remove_worker(second.id(), "gone", 1s);
  EXPECT_EQ(farm.name_of_worker(second.id()), "");
  EXPECT_EQ(FakeWorker(farm, pc()).name(), "pc-2");
}

TEST(Farm, AWorkerIsShownWithWhatItHoldsDeliveredAndHowFastItIs) {
  Farm farm;
  FakeWorker worker(farm, pc(), 3s);
  EXPECT_EQ(farm.workers().at(0).state, WorkerState::idle);
  EXPECT_EQ(farm.workers().at(0).samples_per_second, 0);
  farm.submit(job_of({640, 64}), 3s);
  for (int i = 1; i <= 4; ++i) worker.finish_one(3s + i * 2s, 2.0);
  const WorkerView view = farm.workers().at(0);
  EXPECT_EQ(view.state, WorkerState::busy);
  EXPECT_EQ(view.leases, 4u);
  EXPECT_EQ(view.tiles, 4u);
  EXPECT_EQ(view.pixels, 4u * 64u * 64u);
  EXPECT_NEAR(view.samples_per_second, 2 * 64 * 64 * 16 / 2.0, 1e-3) << "two threads, 16 spp, 2 s a tile";
  EXPECT_EQ(view.joined, 3s);
}

TEST(Farm, AJobIsShownWithItsProgressAndExactCounters) {
  Farm farm;
  const Size film{130, 70};
  const JobId job = farm.submit(job_of(film), 5s);
  EXPECT_EQ(farm.job(job, 6s)->state, JobState::waiting);
  EXPECT_EQ(farm.job(job, 6s)->elapsed, 0s);
  FakeWorker worker(farm, pc(), 7s);
  EXPECT_EQ(farm.job(job, 9s)->state, JobState::running);
  EXPECT_EQ(farm.job(job, 9s)->elapsed, 2s);
  worker.finish_all(10s);
  const JobView view = farm.job(job, 60s).value();
  EXPECT_EQ(view.state, JobState::done);
  EXPECT_EQ(view.submitted, 5s);
  EXPECT_EQ(view.elapsed, 3s);
  EXPECT_EQ(view.pixels_done, 130u * 70u);
  EXPECT_EQ(view.pixels_total, 130u * 70u);
  EXPECT_EQ(view.counters, made_up_counters(film));
  EXPECT_EQ(view.eta, std::nullopt);
}

TEST(Farm, TheTimeToGoOfASteadyJobRunsDown) {
  Farm farm;
  FakeWorker worker(farm, pc());
  const JobId job = farm.submit(job_of({100 * 64, 64}), 0s);
  EXPECT_EQ(farm.job(job, 1s)->eta, std::nullopt) << "nothing to learn from yet";
  for (int done = 1; done < 100; ++done) {
    worker.finish_one(done * 500ms, 1.0);
    const FarmTime eta = farm.job(job, done * 500ms)->eta.value();
    EXPECT_NEAR(std::chrono::duration<double>(eta).count(), (100 - done) * 0.5, 1e-6);
  }
}

TEST(Farm, APausedJobHasNoTimeToGoAndLearnsItAnew) {
  Farm farm;
  FakeWorker worker(farm, pc());
  const JobId job = farm.submit(job_of({100 * 64, 64}), 0s);
  for (int i = 1; i <= 10; ++i) worker.finish_one(i * 1s);
  farm.pause(job, 10s);
  EXPECT_EQ(farm.job(job, 10s)->eta, std::nullopt);
  farm.resume(job, 1000s);
  EXPECT_EQ(farm.job(job, 1000s)->eta, std::nullopt);
  worker.finish_one(1001s);
  EXPECT_EQ(farm.job(job, 1001s)->eta, 89s);
}

TEST(Farm, LeasesWithoutAResultAreCounted) {
  Farm farm;
  FakeWorker worker(farm, pc());
  const JobId job = farm.submit(job_of({640, 64}), 0s);
  farm.remove_worker(worker.id(), "gone", 1s);
  EXPECT_EQ(farm.job(job, 1s)->tiles_given_back, 2u);
}

TEST(Farm, EachEventIsOneLineThatSaysWhoAndWhy) {
  Farm farm;
  FakeWorker worker(farm, pc());
  const JobId job = farm.submit(job_of({320, 64}, "flake"), 0s);
  farm.pause(job, 0s);
  farm.resume(job, 0s);
  farm.drain("pc", 0s);
  farm.undrain("pc", 0s);
  farm.remove_worker(worker.id(), "silent for 2 s", 1s);
  FakeWorker again(farm, pc());
  again.finish_all(2500ms);
  farm.cancel(farm.submit(job_of({64, 64}), 3s), 3s);
  const std::vector<std::string> expected{
      "worker pc joined from 10.0.0.7 with 2 threads, Xeon",
      "job 1 (flake) submitted: 320x64, 16 spp, priority 50",
      "job 1 (flake) started",
      "job 1 (flake) paused",
      "job 1 (flake) resumed",
      "worker pc drained; 2 tiles given back",
      "worker pc no longer drained",
      "! worker pc lost: silent for 2 s; 2 tiles given back",
      "worker pc joined from 10.0.0.7 with 2 threads, Xeon",
      "job 1 (flake) done in 2.5 s",
      "job 2 (picture) submitted: 64x64, 16 spp, priority 50",
      "job 2 (picture) started",
      "job 2 (picture) cancelled",
  };
  EXPECT_EQ(texts_of(farm), expected);
  EXPECT_TRUE(texts_of(farm).empty());
}

TEST(Farm, StatesHaveNames) {
  for (const auto& [state, name] : {std::pair{JobState::waiting, "waiting"},
                                    {JobState::running, "running"},
                                    {JobState::paused, "paused"},
                                    {JobState::done, "done"},
                                    {JobState::cancelled, "cancelled"},
                                    {JobState::failed, "failed"}})
    EXPECT_EQ(name_of(state), name);
  EXPECT_EQ(name_of(WorkerState::idle), "idle");
  EXPECT_EQ(name_of(WorkerState::busy), "busy");
  EXPECT_EQ(name_of(WorkerState::drained), "drained");
}

#ifndef RAYFARM_SANITIZED  // which needs terabytes of address space for itself
TEST(Farm, AJobTooBigForTheMastersMemoryFailsAndTheNextOneIsServed) {
  rlimit unlimited{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &unlimited), 0);
  const rlimit four_gigabytes{rlim_t{4} << 30, unlimited.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_AS, &four_gigabytes), 0);
  Farm farm;
  const JobId big = farm.submit(job_of({60'000, 8'000}), 0s), small = farm.submit(job_of({64, 64}), 0s);
  FakeWorker worker(farm, pc());
  setrlimit(RLIMIT_AS, &unlimited);
  EXPECT_EQ(farm.job(big, 0s)->state, JobState::failed);
  EXPECT_NE(farm.job(big, 0s)->message.find("60000x8000"), std::string::npos);
  EXPECT_EQ(farm.film(big), nullptr);
  EXPECT_EQ(farm.job(small, 0s)->state, JobState::running);
}
#endif

TEST(Farm, TheRevisionGrowsWithEveryChangeOfAJob) {
  Farm farm;
  FakeWorker worker(farm, pc());
  std::uint64_t last = farm.revision();
  const auto has_grown = [&] { return std::exchange(last, farm.revision()) < farm.revision(); };
  const JobId job = farm.submit(job_of({640, 64}), 0s);
  EXPECT_TRUE(has_grown());
  worker.finish_one();
  EXPECT_TRUE(has_grown());
  farm.pause(job, 0s);
  EXPECT_TRUE(has_grown());
  farm.resume(job, 0s);
  EXPECT_TRUE(has_grown());
  farm.set_priority(job, 7, 0s);
  EXPECT_TRUE(has_grown());
  farm.workers(), farm.jobs(0s), farm.film(job);
  EXPECT_FALSE(has_grown());
  farm.cancel(job, 0s);
  EXPECT_TRUE(has_grown());
}

}  // namespace
}  // namespace rayfarm
