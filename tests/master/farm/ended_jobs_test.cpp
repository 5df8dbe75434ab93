// What the farm keeps of jobs that have ended, so that a master can run for ever.
#include <gtest/gtest.h>

#include "master/farm_record.h"
#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size one_tile{64, 64};
constexpr std::uint64_t one_film = 64 * 64 * 12, one_scene = 3;

WorkerInfo pc() { return {.name = "pc", .threads = 2}; }

JobId done_job(Farm& farm, FakeWorker& worker, Size size = one_tile) {
  const JobId job = farm.submit(job_of(size), 0s);
  worker.finish_all();
  return job;
}

std::vector<JobId> known_jobs(const Farm& farm) {
  std::vector<JobId> known;
  for (const JobView& job : farm.jobs(0s)) known.push_back(job.id);
  return known;
}

/// Whether anybody still has the job's scene.
struct WatchedScene {
  std::weak_ptr<const std::vector<std::uint8_t>> bytes;

  JobId submit_to(Farm& farm, std::string hash = "watched") {
    JobSpec spec = job_of(one_tile, "picture", std::move(hash));
    bytes = spec.scene_bytes;
    return farm.submit(std::move(spec), 0s);
  }
};

TEST(EndedJobs, KeepTheirFilmsWithinTheBudgetTheNewestFirst) {
  Farm farm({.film_bytes = 2 * one_film + one_scene});
  FakeWorker worker(farm, pc());
  for (int i = 0; i < 5; ++i) done_job(farm, worker);
  for (const JobView& job : farm.jobs(0s)) {
    const bool is_kept = job.id >= JobId{4};
    EXPECT_EQ(farm.film(job.id) != nullptr, is_kept);
    EXPECT_EQ(job.message, is_kept ? "" : "its picture is no longer kept");
    EXPECT_EQ(job.state, JobState::done);
    EXPECT_EQ(job.pixels_done, 64u * 64u);
  }
  EXPECT_EQ(farm.film(JobId{5})->rgb(), made_up_picture(JobId{5}, one_tile));
}

TEST(EndedJobs, TheLastOneKeepsItsFilmHoweverBig) {
  Farm farm({.film_bytes = one_film});
  FakeWorker worker(farm, pc());
  const JobId small = done_job(farm, worker), big = done_job(farm, worker, {640, 640});
  EXPECT_EQ(farm.film(small), nullptr);
  EXPECT_NE(farm.film(big), nullptr);
  const JobId next = done_job(farm, worker);
  EXPECT_EQ(farm.film(big), nullptr);
  EXPECT_NE(farm.film(next), nullptr);
}

TEST(EndedJobs, OneThatNeverBeganDropsNobodysFilm) {
  Farm farm({.film_bytes = 0});
  FakeWorker worker(farm, pc());
  const JobId done = done_job(farm, worker);
  JobSpec on_hold = job_of(one_tile);
  on_hold.hold = true;
  farm.cancel(farm.submit(on_hold, 0s), 0s);
  EXPECT_NE(farm.film(done), nullptr);
}

TEST(EndedJobs, FilmsOfJobsThatGoOnDoNotCountAndAreNotDropped) {
  Farm farm({.film_bytes = one_film});
  FakeWorker worker(farm, pc());
  const JobId paused = farm.submit(job_of({640, 640}), 0s);
  worker.finish_one();
  farm.pause(paused, 0s);
  const JobId first = done_job(farm, worker);
  EXPECT_NE(farm.film(first), nullptr);
  done_job(farm, worker);
  EXPECT_NE(farm.film(paused), nullptr);
  farm.resume(paused, 0s);
  worker.finish_all();
  EXPECT_EQ(farm.film(paused)->rgb(), made_up_picture(paused, {640, 640}));
}

TEST(EndedJobs, ACancelledJobWhosePictureIsDroppedStillSaysHowMuchWasDone) {
  Farm farm({.film_bytes = one_film});
  FakeWorker worker(farm, pc());
  const JobId cancelled = farm.submit(job_of({640, 64}), 0s);
  worker.finish_one();
  farm.cancel(cancelled, 0s);
  EXPECT_EQ(farm.film(cancelled)->pixels_done(), 64u * 64u);
  done_job(farm, worker);
  EXPECT_EQ(farm.film(cancelled), nullptr);
  EXPECT_EQ(farm.job(cancelled, 0s)->pixels_done, 64u * 64u);
}

TEST(EndedJobs, AreForgottenWhenTheyAreTooMany) {
  Farm farm({.jobs = 3});
  FakeWorker worker(farm, pc());
  const JobId held = farm.submit(
      [] {
        JobSpec spec = job_of(one_tile);
        spec.hold = true;
        return spec;
      }(),
      0s);
  for (int i = 0; i < 5; ++i) done_job(farm, worker);
  EXPECT_EQ(known_jobs(farm), (std::vector{held, JobId{4}, JobId{5}, JobId{6}}));
  EXPECT_EQ(farm.job(JobId{2}, 0s), std::nullopt);
  EXPECT_FALSE(farm.cancel(JobId{2}, 0s));
}

TEST(EndedJobs, AreForgottenWhenTheyEndedTooLongAgo) {
  Farm farm({.job_age = 10s});
  FakeWorker worker(farm, pc());
  const JobId done = farm.submit(job_of(one_tile), 0s), cancelled = farm.submit(job_of(one_tile), 0s);
  const JobId paused = farm.submit(job_of(one_tile), 0s), held = farm.submit(job_of(one_tile), 0s);
  farm.pause(paused, 0s), farm.pause(held, 0s);
  worker.finish_one(5s);
  farm.cancel(cancelled, 6s);
  const JobId live = farm.submit(job_of({640, 64}), 7s);
  worker.finish_one(8s);
  const std::uint64_t before = farm.revision();

  farm.tick(14s);
  EXPECT_EQ(known_jobs(farm), (std::vector{done, cancelled, paused, held, live}));
  farm.tick(15s);
  EXPECT_EQ(known_jobs(farm), (std::vector{cancelled, paused, held, live}));
  EXPECT_NE(farm.revision(), before) << "who waits for news is told";
  farm.tick(1000s);
  EXPECT_EQ(known_jobs(farm), (std::vector{paused, held, live})) << "what has not ended is never too old";
  EXPECT_NE(farm.film(live), nullptr);

  EXPECT_TRUE(farm.was_here(done));
  EXPECT_FALSE(farm.was_here(live));
  EXPECT_FALSE(farm.was_here(JobId{99}));
  EXPECT_FALSE(farm.was_here(JobId{0}));
}

TEST(EndedJobs, AgeFromTheirEndWhateverTheTimeOfTheirFrames) {
  Farm farm({.job_age = 10s});
  FakeWorker worker(farm, pc());
  JobSpec animation = job_of(one_tile);
  animation.frames = FrameRange{0, 1, 1};
  const JobId job = farm.submit(animation, 0s);
  worker.finish_all(1s);
  farm.tick(100s);
  EXPECT_NE(farm.film(job, 0), nullptr) << "its other frame has not come yet";
  add_frame(farm, job, 1, 100s);
  worker.finish_all(101s);
  farm.tick(110s);
  EXPECT_NE(farm.film(job, 0), nullptr);
  farm.tick(111s);
  EXPECT_TRUE(farm.was_here(job));
}

TEST(EndedJobs, CanBeRemovedAndNoOthers) {
  Farm farm;
  FakeWorker worker(farm, pc());
  JobSpec keyed = job_of(one_tile);
  keyed.key = "mine";
  const JobId done = farm.submit(keyed, 0s);
  worker.finish_all();
  const JobId kept = done_job(farm, worker);
  const JobId live = farm.submit(job_of(one_tile), 0s);
  EXPECT_FALSE(farm.remove(live));
  farm.pause(live, 0s);
  EXPECT_FALSE(farm.remove(live));
  EXPECT_TRUE(farm.remove(done));
  EXPECT_FALSE(farm.remove(done));
  EXPECT_EQ(known_jobs(farm), (std::vector{kept, live}));
  EXPECT_EQ(farm.film(kept)->rgb(), made_up_picture(kept, one_tile));
  EXPECT_TRUE(farm.was_here(done));
  EXPECT_GT(farm.submit(keyed, 0s), live) << "its key is free";
}

TEST(EndedJobs, LeaveRoomForOthersWhenTheyAreRemoved) {
  Farm farm({.film_bytes = 2 * one_film + one_scene});
  FakeWorker worker(farm, pc());
  const JobId first = done_job(farm, worker), second = done_job(farm, worker);
  farm.remove(second);
  const JobId third = done_job(farm, worker);
  EXPECT_NE(farm.film(first), nullptr);
  farm.remove(first), farm.remove(third);
  WatchedScene scene;
  const JobId last = scene.submit_to(farm, "scene");
  worker.finish_all();
  farm.remove(last);
  worker.take_messages(), farm.take_records();
  EXPECT_TRUE(scene.bytes.expired()) << "nobody else shows it";
}

TEST(EndedJobs, FreeTheirKeysWithTheirPictures) {
  Farm farm({.film_bytes = one_film});
  FakeWorker worker(farm, pc());
  JobSpec keyed = job_of(one_tile);
  keyed.key = "mine";
  const JobId job = farm.submit(keyed, 0s);
  worker.finish_all();
  EXPECT_EQ(farm.submit(keyed, 0s), job);
  done_job(farm, worker);
  EXPECT_NE(farm.submit(keyed, 0s), job);
}

TEST(EndedJobs, KeepTheirScenesWhenTheyAreDoneAsLongAsTheirFilms) {
  Farm farm({.film_bytes = one_film + one_scene});
  FakeWorker worker(farm, pc());
  WatchedScene scene;
  const JobId job = scene.submit_to(farm);
  EXPECT_EQ(farm.scene(job), scene.bytes.lock());
  worker.finish_all();
  EXPECT_NE(farm.scene(job), nullptr);
  done_job(farm, worker);
  worker.take_messages();
  EXPECT_EQ(farm.film(job), nullptr);
  EXPECT_EQ(farm.scene(job), nullptr);
  farm.take_records();  // they hold it, too
  EXPECT_TRUE(scene.bytes.expired());
}

TEST(EndedJobs, DropTheirScenesWhenTheyAreNotDone) {
  Farm farm;
  FakeWorker worker(farm, pc());
  WatchedScene cancelled, failed;
  const JobId first = cancelled.submit_to(farm, "cancelled");
  farm.cancel(first, 0s);
  const JobId second = failed.submit_to(farm, "failed");
  farm.receive(worker.id(), GiveBack{{worker.held().at(0).lease}, "too big"}, 0s);
  EXPECT_EQ(farm.job(second, 0s)->state, JobState::failed);
  worker.take_messages();
  for (const JobId job : {first, second}) EXPECT_EQ(farm.scene(job), nullptr);
  farm.take_records();  // they hold them, too
  EXPECT_TRUE(cancelled.bytes.expired());
  EXPECT_TRUE(failed.bytes.expired());
}

TEST(EndedJobs, PayForASharedSceneOnce) {
  Farm farm({.film_bytes = 3 * one_film + one_scene});
  FakeWorker worker(farm, pc());
  const JobId first = done_job(farm, worker);
  done_job(farm, worker), done_job(farm, worker);
  EXPECT_NE(farm.film(first), nullptr);
}

TEST(UnfinishedJobs, ShareTheBytesOfTheirScene) {
  Farm farm;
  const JobSpec first = job_of(one_tile), second = job_of(one_tile);
  farm.submit(first, 0s);
  farm.submit(second, 0s);
  farm.take_records();  // they share them, too
  EXPECT_EQ(first.scene_bytes.use_count(), 3);
  EXPECT_EQ(second.scene_bytes.use_count(), 1);
}

TEST(UnfinishedJobs, AreBoundedInNumberAndInTheBytesOfTheirScenes) {
  for (const FarmLimits limits : {FarmLimits{.unfinished_jobs = 2}, FarmLimits{.scene_bytes = 2 * 3}}) {
    Farm farm(limits);
    farm.submit(job_of(one_tile, "a", "scene a"), 0s);
    const JobId b = farm.submit(job_of(one_tile, "b", "scene b"), 0s);
    const JobSpec c = job_of(one_tile, "c", "scene c");
    EXPECT_THROW(farm.submit(c, 0s), SettingsError);
    EXPECT_EQ(farm.jobs(0s).size(), 2u);
    farm.cancel(b, 0s);
    EXPECT_NO_THROW(farm.submit(c, 0s));
  }
}

TEST(UnfinishedJobs, AreNotHinderedByTheScenesOfThoseThatAreDone) {
  Farm farm({.scene_bytes = one_scene});
  FakeWorker worker(farm, pc());
  const JobId done = farm.submit(job_of(one_tile, "a", "scene a"), 0s);
  worker.finish_all();
  farm.submit(job_of({640, 640}, "b", "scene b"), 0s);
  EXPECT_THROW(farm.submit(job_of(one_tile, "c", "scene a"), 0s), SettingsError) << "b goes on";
  EXPECT_NO_THROW(farm.submit(job_of(one_tile, "d", "scene b"), 0s));
  worker.finish_all();
  const JobId again = farm.submit(job_of(one_tile, "e", "scene a"), 0s);
  EXPECT_EQ(farm.scene(again), farm.scene(done));
}

// An honest worker's result may be under way while other jobs end.
TEST(EndedJobs, LateResultsForThemAreNoLies) {
  for (const FarmLimits limits : {FarmLimits{.film_bytes = 0}, FarmLimits{.jobs = 1}}) {
    Farm farm(limits);
    FakeWorker worker(farm, pc());
    const JobId job = farm.submit(job_of({640, 64}), 0s);
    const Assignment late = worker.held().at(0);
    farm.cancel(job, 0s);
    done_job(farm, worker);
    ASSERT_EQ(farm.film(job), nullptr);
    EXPECT_NO_THROW(farm.receive(worker.id(), rendered(late, {640, 64}), 1s));
  }
}

}  // namespace
}  // namespace rayfarm
