// Who gets what, and what is taken away from whom.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size ten_tiles{5 * 64, 2 * 64};

WorkerInfo remote(std::string name, std::uint32_t threads = 4) {
  return {.name = std::move(name), .threads = threads};
}
WorkerInfo local(std::uint32_t threads = 2) {
  return {.name = "master", .threads = threads, .kind = WorkerKind::local};
}

std::vector<std::uint32_t> tiles_of(const std::vector<HeldAssignment>& assignments) {
  std::vector<std::uint32_t> tiles;
  for (const Assignment& a : assignments) tiles.push_back(a.tile);
  return tiles;
}

template <class Message>
int count_of(const std::vector<ToWorker>& messages) {
  return static_cast<int>(
      std::ranges::count_if(messages, [](auto& m) { return std::holds_alternative<Message>(m); }));
}

TEST(Farm, AWorkerHoldsALeaseForEachThreadAndTwoMoreOnceItHasShownWhatItCanDo) {
  Farm farm;
  FakeWorker worker(farm, remote("pc", 3));
  farm.submit(job_of(ten_tiles), 0s);
  EXPECT_EQ(worker.held().size(), 3u);
  worker.finish_one(1s);
  EXPECT_EQ(worker.held().size(), 5u);
}

TEST(Farm, AFastWorkerHoldsAQuarterOfASecondOfWork) {
  Farm farm;
  FakeWorker worker(farm, remote("pc", 2));
  farm.submit(job_of({100 * 64, 64}), 0s);
  for (int i = 1; i <= 20; ++i) worker.finish_one(i * 20ms, 0.020);  // 50 tiles a second and thread
  EXPECT_NEAR(static_cast<double>(worker.held().size()), 25, 1);
}

TEST(Farm, ASlowWorkerHoldsNoMoreThanThreadsAndTwo) {
  Farm farm;
  FakeWorker worker(farm, remote("pc", 2));
  farm.submit(job_of({100 * 64, 64}), 0s);
  for (int i = 1; i <= 20; ++i) worker.finish_one(i * 1s, 1.0);
  EXPECT_EQ(worker.held().size(), 4u);
}

TEST(Farm, AWorkerThatClaimsToBeInfinitelyFastHoldsABoundedNumberOfLeases) {
  Farm farm;
  FakeWorker worker(farm, remote("pc", 2));
  farm.submit(job_of({60'000, 640}), 0s);
  for (int i = 1; i <= 20; ++i) worker.finish_one(i * 1s, 0.0);
  EXPECT_EQ(worker.held().size(), 1024u);
}

TEST(Farm, AJobStartsWithItsFirstAssignment) {
  Farm farm;
  FakeWorker worker(farm, remote("pc", 2));
  farm.submit(job_of(ten_tiles), 0s);
  JobSpec urgent = job_of(ten_tiles);
  urgent.priority = 99;
  const JobId next = farm.submit(urgent, 0s);
  EXPECT_EQ(farm.job(next, 0s)->state, JobState::waiting) << "though nobody has room for it";
  EXPECT_EQ(farm.film(next), nullptr);
  worker.finish_one(1s);
  EXPECT_EQ(farm.job(next, 1s)->state, JobState::running);
  EXPECT_EQ(worker.held().back().job, next);
}

TEST(Farm, FewTilesAreSpreadOverAllWorkers) {
  Farm farm;
  std::vector<FakeWorker> workers;
  for (int i = 0; i < 10; ++i) workers.emplace_back(farm, remote("pc", 8));
  farm.submit(job_of(ten_tiles), 0s);
  for (const FakeWorker& worker : workers) EXPECT_EQ(worker.held().size(), 1u);
}

TEST(Farm, ALostWorkersTilesGoFirstToTheNext) {
  Farm farm;
  FakeWorker lost(farm, remote("lost"));
  farm.submit(job_of({100 * 64, 64}), 0s);
  const std::vector<std::uint32_t> tiles = tiles_of(lost.held());
  FakeWorker other(farm, remote("other"));
  farm.remove_worker(lost.id(), "connection reset", 1s);
  for (int i = 0; i < 4; ++i) other.finish_one(1s);
  std::vector<std::uint32_t> next = tiles_of(other.held());
  next.resize(tiles.size());
  EXPECT_EQ(next, tiles);
}

TEST(Farm, AnIdleWorkerGetsALostWorkersTilesAtOnce) {
  Farm farm;
  FakeWorker lost(farm, remote("lost"));
  farm.submit(job_of({128, 128}), 0s);
  FakeWorker idle(farm, remote("idle"));
  EXPECT_TRUE(idle.held().empty());
  farm.remove_worker(lost.id(), "connection reset", 1s);
  EXPECT_EQ(idle.held().size(), 4u);
}

TEST(Farm, LocalThreadsSeeTheWholePictureCoarseFirst) {
  Farm farm;
  farm.submit(job_of(ten_tiles), 0s);
  FakeWorker threads(farm, local());
  const std::vector<std::uint32_t> centre = centre_first(ten_tiles);
  for (int pass = 0; pass < pass_count; ++pass)
    for (const std::uint32_t tile : centre) {
      EXPECT_EQ(threads.held().at(0).tile, tile);
      EXPECT_EQ(threads.held().at(0).passes, 1 << pass);
      threads.finish_one();
    }
  EXPECT_EQ(farm.job(JobId{1}, 0s)->state, JobState::done);
}

TEST(Farm, AWorkerGetsOnlyThePixelsNotThereYet) {
  Farm farm;
  farm.submit(job_of(ten_tiles), 0s);
  FakeWorker threads(farm, local());
  for (int i = 0; i < 10; ++i) threads.finish_one();
  FakeWorker worker(farm, remote("pc"));
  for (const Assignment& a : worker.held()) EXPECT_EQ(a.passes & 1, 0);
  while (!worker.held().empty() || !threads.held().empty()) worker.finish_all(), threads.finish_all();
  EXPECT_EQ(farm.film(JobId{1})->rgb(), made_up_picture(JobId{1}, ten_tiles));
}

TEST(Farm, TheJobOfHigherPriorityIsServedFirstAndEqualsInOrderOfSubmission) {
  Farm farm;
  JobSpec low = job_of({64, 64}, "low"), high = job_of({64, 64}, "high");
  low.priority = 10, high.priority = 90;
  const JobId low_id = farm.submit(low, 0s), first = farm.submit(job_of({64, 64}), 0s),
              second = farm.submit(job_of({64, 64}), 0s), high_id = farm.submit(high, 0s);
  FakeWorker worker(farm, remote("pc"));
  std::vector<JobId> served;
  for (const Assignment& a : worker.held()) served.push_back(a.job);
  EXPECT_EQ(served, (std::vector<JobId>{high_id, first, second, low_id}));
}

TEST(Farm, AHigherJobGetsTheNextFreeSlots) {
  Farm farm;
  farm.submit(job_of(ten_tiles), 0s);
  FakeWorker worker(farm, remote("pc"));
  JobSpec urgent = job_of(ten_tiles, "urgent");
  urgent.priority = 51;
  const JobId id = farm.submit(urgent, 0s);
  worker.finish_one();
  EXPECT_EQ(worker.held().back().job, id);
  farm.set_priority(id, 49, 0s);
  worker.finish_one();
  EXPECT_EQ(worker.held().back().job, JobId{1});
}

TEST(Farm, ASceneIsSentOnceForAllItsJobsAndAgainOnlyWhenItWasForgotten) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  farm.submit(job_of({64, 64}, "a", "same"), 0s);
  farm.submit(job_of({64, 64}, "b", "same"), 0s);
  farm.submit(job_of({64, 64}, "c", "other"), 0s);
  std::vector<ToWorker> messages = worker.take_messages();
  EXPECT_EQ(count_of<SceneData>(messages), 2);
  EXPECT_EQ(count_of<FrameStart>(messages), 3);
  worker.finish_all();
  EXPECT_EQ(count_of<FrameEnd>(worker.take_messages()), 3);
  farm.submit(job_of({64, 64}, "d", "same"), 0s);
  EXPECT_EQ(count_of<SceneData>(worker.take_messages()), 1);
}

TEST(Farm, AWorkerIsWelcomedThenSentTheSceneThenTheJob) {
  Farm farm;
  farm.submit(job_of({64, 64}), 0s);
  FakeWorker worker(farm, remote("pc"));
  const std::vector<ToWorker> messages = worker.take_messages();
  ASSERT_EQ(messages.size(), 3u);
  EXPECT_EQ(std::get<Welcome>(messages[0]).name, "pc");
  EXPECT_EQ(std::get<SceneData>(messages[1]).hash, "scene");
  EXPECT_EQ(std::get<FrameStart>(messages[2]).scene_hash, "scene");
}

TEST(Farm, PausingRevokesAtOnceAndResumingGoesOn) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  const JobId job = farm.submit(job_of(ten_tiles), 0s);
  worker.finish_one(1s);
  EXPECT_TRUE(farm.pause(job, 1s));
  EXPECT_TRUE(worker.held().empty());
  EXPECT_EQ(farm.job(job, 1s)->state, JobState::paused);
  EXPECT_TRUE(farm.resume(job, 2s));
  EXPECT_EQ(worker.held().size(), 6u);
  worker.finish_all();
  EXPECT_EQ(farm.job(job, 3s)->state, JobState::done);
}

TEST(Farm, PausingMakesRoomForOtherJobs) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  const JobId first = farm.submit(job_of(ten_tiles), 0s), second = farm.submit(job_of(ten_tiles), 0s);
  farm.pause(first, 0s);
  for (const Assignment& a : worker.held()) EXPECT_EQ(a.job, second);
  EXPECT_EQ(worker.held().size(), 4u);
}

TEST(Farm, AJobOnHoldStartsPaused) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  JobSpec spec = job_of(ten_tiles);
  spec.hold = true;
  const JobId job = farm.submit(spec, 0s);
  EXPECT_TRUE(worker.held().empty());
  EXPECT_EQ(farm.film(job), nullptr) << "a film is big: it is made at the first assignment";
  farm.resume(job, 1s);
  EXPECT_EQ(worker.held().size(), 4u);
}

TEST(Farm, CancellingRevokesAtOnceAndKeepsWhatIsThere) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  const JobId job = farm.submit(job_of(ten_tiles), 0s);
  worker.finish_one();
  worker.take_messages();
  EXPECT_TRUE(farm.cancel(job, 1s));
  EXPECT_TRUE(worker.held().empty());
  EXPECT_EQ(count_of<FrameEnd>(worker.take_messages()), 1);
  EXPECT_EQ(farm.job(job, 2s)->state, JobState::cancelled);
  EXPECT_EQ(farm.film(job)->pixels_done(), 64u * 64u);
}

TEST(Farm, NothingCanBeDoneToAJobThatHasEndedOrNeverWas) {
  Farm farm;
  const JobId job = farm.submit(job_of(ten_tiles), 0s);
  farm.cancel(job, 0s);
  for (const JobId id : {job, JobId{99}}) {
    EXPECT_FALSE(farm.pause(id, 0s));
    EXPECT_FALSE(farm.resume(id, 0s));
    EXPECT_FALSE(farm.cancel(id, 0s));
    EXPECT_FALSE(farm.set_priority(id, 1, 0s));
  }
  EXPECT_EQ(farm.job(JobId{99}, 0s), std::nullopt);
}

TEST(Farm, DrainingRevokesAtOnceAndLastsUntilUndrained) {
  Farm farm;
  const JobId job = farm.submit(job_of(ten_tiles), 0s);
  FakeWorker worker(farm, remote("pc"));
  EXPECT_TRUE(farm.drain("pc", 0s));
  EXPECT_TRUE(worker.held().empty());
  EXPECT_EQ(farm.workers().at(0).state, WorkerState::drained);
  farm.remove_worker(worker.id(), "gone", 1s);

  FakeWorker again(farm, remote("pc"));
  EXPECT_TRUE(again.held().empty());
  EXPECT_TRUE(farm.undrain("pc", 2s));
  EXPECT_EQ(again.held().size(), 4u);
  again.finish_all();
  EXPECT_EQ(farm.job(job, 3s)->state, JobState::done);
  EXPECT_FALSE(farm.drain("nobody", 0s));
  EXPECT_FALSE(farm.undrain("nobody", 0s));
}

TEST(Farm, ADrainedWorkerThatIsAwayCanBeUndrained) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  farm.drain("pc", 0s);
  farm.remove_worker(worker.id(), "gone", 1s);
  EXPECT_TRUE(farm.undrain("pc", 1s));
  farm.submit(job_of(ten_tiles), 2s);
  EXPECT_EQ(FakeWorker(farm, remote("pc")).held().size(), 4u);
}

TEST(Farm, DrainingGivesTheTilesToTheOthersAtOnce) {
  Farm farm;
  FakeWorker first(farm, remote("first"));
  farm.submit(job_of({128, 128}), 0s);
  FakeWorker second(farm, remote("second"));
  EXPECT_TRUE(second.held().empty());
  farm.drain("first", 0s);
  EXPECT_EQ(second.held().size(), 4u);
}

TEST(Farm, TheSameKeyGivesTheSameJob) {
  Farm farm;
  JobSpec spec = job_of(ten_tiles);
  spec.key = "homework";
  const JobId job = farm.submit(spec, 0s);
  EXPECT_EQ(farm.submit(spec, 1s), job);
  spec.key = "other";
  EXPECT_NE(farm.submit(spec, 1s), job);
  EXPECT_EQ(farm.jobs(1s).size(), 2u);
}

TEST(Farm, SettingsThatCannotBeRenderedAreRefused) {
  Farm farm;
  EXPECT_THROW(farm.submit(job_of({0, 10}), 0s), SettingsError);
  EXPECT_TRUE(farm.jobs(0s).empty());
}

}  // namespace
}  // namespace rayfarm
