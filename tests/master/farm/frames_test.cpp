// Jobs of several frames: in what order they are rendered, what is told and kept of each.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size two_tiles{128, 64}, one_tile{64, 64};
constexpr std::uint64_t one_film = 64 * 64 * 12;

WorkerInfo pc(std::uint32_t threads = 2) { return {.name = "pc", .threads = threads}; }

JobSpec animation(Size film, FrameRange frames) {
  JobSpec spec = job_of(film, "animation", "scene " + std::to_string(frames.first));
  spec.frames = frames;
  return spec;
}

/// With the scenes of all frames.
JobId submit_all(Farm& farm, const JobSpec& spec) {
  const JobId id = farm.submit(spec, 0s);
  for (std::uint32_t i = 1; i < spec.frames->count(); ++i) add_frame(farm, id, spec.frames->at(i));
  return id;
}

std::vector<std::uint32_t> frames_of(const std::vector<HeldAssignment>& held) {
  std::vector<std::uint32_t> frames;
  for (const Assignment& a : held) frames.push_back(a.frame);
  return frames;
}

TEST(Frames, FollowEachOtherWithoutAGap) {
  Farm farm;
  FakeWorker first(farm, pc(3)), second(farm, pc(2));
  submit_all(farm, animation(two_tiles, {0, 20, 10}));
  EXPECT_EQ(frames_of(first.held()), (std::vector<std::uint32_t>{0, 10, 20}));
  EXPECT_EQ(frames_of(second.held()), (std::vector<std::uint32_t>{0, 10}));
}

TEST(Frames, AreAllThereInTheEndEachWithItsOwnCounts) {
  Farm farm;
  FakeWorker threads(farm, {.name = "master", .threads = 2, .kind = WorkerKind::local}), worker(farm, pc());
  const JobId job = submit_all(farm, animation(two_tiles, {3, 9, 2}));
  while (!threads.held().empty() || !worker.held().empty()) worker.finish_all(), threads.finish_all();
  const JobView view = farm.job(job, 1s).value();
  EXPECT_EQ(view.state, JobState::done);
  EXPECT_EQ(view.frames, (FrameRange{3, 9, 2}));
  EXPECT_EQ(view.frames_done, 4u);
  EXPECT_EQ(view.current_frame, std::nullopt);
  EXPECT_EQ(view.pixels_done, 4u * 128u * 64u);
  RayCounters sum;
  for (const FrameView& frame : farm.frames(job, 1s)) {
    EXPECT_EQ(frame.state, JobState::done);
    EXPECT_EQ(frame.counters, made_up_counters(two_tiles));
    EXPECT_EQ(farm.film(job, frame.frame)->rgb(), made_up_picture(job, two_tiles, frame.frame));
    sum += frame.counters;
  }
  EXPECT_EQ(view.counters, sum);
  EXPECT_EQ(farm.film(job), farm.film(job, 3));
  EXPECT_EQ(farm.film(job, 4), nullptr);
  EXPECT_EQ(farm.frame(job, 4, 1s), std::nullopt);
}

TEST(Frames, AWorkerHasTheNextScenesBeforeItsTiles) {
  Farm farm;
  submit_all(farm, animation(two_tiles, {0, 2, 1}));
  FakeWorker worker(farm, pc(1));
  std::vector<std::uint32_t> started;
  for (const ToWorker& message : worker.take_messages())
    if (const auto* start = std::get_if<FrameStart>(&message)) started.push_back(start->settings.frame);
  EXPECT_EQ(frames_of(worker.held()), (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(started, (std::vector<std::uint32_t>{0, 1}));
}

TEST(Frames, AWorkerForgetsEachWhenItIsDone) {
  Farm farm;
  FakeWorker worker(farm, pc(1));
  submit_all(farm, animation(one_tile, {0, 2, 1}));
  worker.take_messages();
  worker.finish_one();
  const auto messages = worker.take_messages();
  const auto has_ended = [](const ToWorker& m) {
    return std::holds_alternative<FrameEnd>(m) && std::get<FrameEnd>(m).frame == 0;
  };
  EXPECT_EQ(std::ranges::count_if(messages, has_ended), 1);
}

TEST(Frames, OneGivenBackComesBeforeTheNext) {
  Farm farm;
  FakeWorker lost(farm, pc(1));
  submit_all(farm, animation(two_tiles, {0, 5, 1}));
  FakeWorker other(farm, pc(1));
  EXPECT_EQ(frames_of(other.held()), (std::vector<std::uint32_t>{0}));
  farm.remove_worker(lost.id(), "gone", 1s);
  other.finish_one(1s);
  EXPECT_EQ(other.held().front().frame, 0u);
}

TEST(Frames, WaitForTheirScenesAndGoOnWhenTheyCome) {
  Farm farm;
  FakeWorker worker(farm, pc());
  const JobId job = farm.submit(animation(one_tile, {0, 2, 1}), 0s);
  worker.finish_all(1s);
  JobView view = farm.job(job, 1s).value();
  EXPECT_EQ(view.state, JobState::running);
  EXPECT_EQ(view.frames_sent, 1u);
  EXPECT_EQ(view.frames_done, 1u);
  EXPECT_EQ(view.current_frame, 1u);
  EXPECT_EQ(farm.frames(job, 1s).at(2).state, JobState::waiting);
  EXPECT_TRUE(add_frame(farm, job, 1, 2s));
  EXPECT_EQ(frames_of(worker.held()), (std::vector<std::uint32_t>{1}));
  EXPECT_TRUE(add_frame(farm, job, 2, 2s));
  worker.finish_all(3s);
  EXPECT_EQ(farm.job(job, 3s)->state, JobState::done);
}

TEST(Frames, ComeInOrderAndOnce) {
  Farm farm;
  const JobId job = farm.submit(animation(one_tile, {0, 4, 2}), 0s);
  EXPECT_THROW(add_frame(farm, job, 4), SettingsError) << "2 is next";
  EXPECT_THROW(add_frame(farm, job, 3), SettingsError) << "it is none of them";
  EXPECT_TRUE(add_frame(farm, job, 2));
  EXPECT_TRUE(add_frame(farm, job, 2)) << "the same again";
  const auto other = std::make_shared<const std::vector<std::uint8_t>>(3, std::uint8_t{1});
  EXPECT_THROW(farm.add_frame({job, 2}, "another scene", other, 0s), KeyTaken);
  EXPECT_TRUE(add_frame(farm, job, 4));
  EXPECT_THROW(add_frame(farm, job, 6), SettingsError) << "all have come";
  EXPECT_EQ(farm.job(job, 0s)->frames_sent, 3u);
  EXPECT_FALSE(add_frame(farm, JobId{9}, 0));
  farm.cancel(job, 0s);
  EXPECT_TRUE(add_frame(farm, job, 4)) << "it is there";
}

TEST(Frames, AStillHasOneAndItsSettingsSayWhich) {
  Farm farm;
  FakeWorker worker(farm, pc());
  JobSpec spec = job_of(one_tile);
  spec.settings.frame = 12;
  const JobId job = farm.submit(spec, 0s);
  EXPECT_EQ(farm.job(job, 0s)->frames, (FrameRange{12, 12, 1}));
  EXPECT_EQ(farm.job(job, 0s)->current_frame, 12u);
  worker.finish_all();
  EXPECT_EQ(farm.film(job), farm.film(job, 12));
}

TEST(Frames, ArePausedAndCancelledTogether) {
  Farm farm;
  FakeWorker worker(farm, pc(4));
  const JobId job = submit_all(farm, animation(two_tiles, {0, 4, 1}));
  worker.finish_one(), worker.finish_one();
  farm.pause(job, 1s);
  EXPECT_TRUE(worker.held().empty());
  EXPECT_EQ(farm.frame(job, 0, 1s)->state, JobState::done);
  EXPECT_EQ(farm.frame(job, 1, 1s)->state, JobState::paused);
  farm.resume(job, 2s);
  EXPECT_EQ(worker.held().front().frame, 1u);
  worker.take_messages();
  farm.cancel(job, 3s);
  const auto ends = worker.take_messages();
  EXPECT_GE(std::ranges::count_if(ends, [](auto& m) { return std::holds_alternative<FrameEnd>(m); }), 3);
  EXPECT_EQ(farm.frame(job, 0, 3s)->state, JobState::done);
  EXPECT_EQ(farm.frame(job, 4, 3s)->state, JobState::cancelled);
  EXPECT_NE(farm.scene(job, 0), nullptr) << "how it came about can still be asked";
  EXPECT_EQ(farm.scene(job, 4), nullptr);
  EXPECT_NE(farm.film(job, 0), nullptr);
}

TEST(Frames, KeepTheirFilmsWithinTheBudgetTheNewestFirstAlsoWhileTheJobGoesOn) {
  Farm farm({.film_bytes = 2 * one_film + 6});
  FakeWorker worker(farm, pc(1));
  const JobId job = farm.submit(animation(one_tile, {0, 4, 1}), 0s);
  for (std::uint32_t frame = 1; frame <= 3; ++frame) add_frame(farm, job, frame);
  worker.finish_all();
  EXPECT_EQ(farm.job(job, 0s)->state, JobState::running);
  EXPECT_EQ(farm.job(job, 0s)->message, "of its pictures the 2 oldest are no longer kept");
  for (const FrameView& frame : farm.frames(job, 0s)) {
    EXPECT_EQ(frame.is_kept, frame.frame == 2 || frame.frame == 3);
    EXPECT_EQ(farm.scene(job, frame.frame) != nullptr, frame.is_kept);
    EXPECT_EQ(frame.state, frame.frame < 4 ? JobState::done : JobState::waiting);
  }
}

TEST(Frames, TheirScenesAreBoundedAndRoomComesBackAsTheyAreDone) {
  Farm farm({.scene_bytes = 2 * 3});
  const JobId job = farm.submit(animation(one_tile, {0, 3, 1}), 0s);
  EXPECT_TRUE(add_frame(farm, job, 1));
  EXPECT_THROW(add_frame(farm, job, 2), FarmFull);
  FakeWorker worker(farm, pc(1));
  worker.finish_one();
  EXPECT_TRUE(add_frame(farm, job, 2));
}

TEST(Frames, TheTimeToGoIsThatOfAllOfThem) {
  Farm farm;
  FakeWorker worker(farm, pc(1));
  const JobId job = submit_all(farm, animation(one_tile, {0, 99, 1}));
  for (int done = 1; done < 100; ++done) {
    worker.finish_one(done * 1s);
    EXPECT_EQ(farm.job(job, done * 1s)->eta, (100 - done) * 1s);
  }
}

TEST(Frames, ThatCostWorkerAfterWorkerFailTheirJob) {
  Farm farm;
  const JobId deadly = farm.submit(animation(two_tiles, {0, 4, 1}), 0s),
              good = farm.submit(job_of(one_tile), 0s);
  for (int i = 1; i <= 5; ++i) {
    EXPECT_EQ(farm.job(deadly, 0s)->state, i == 1 ? JobState::waiting : JobState::running);
    FakeWorker worker(farm, {.name = "pc" + std::to_string(i), .threads = 1});
    EXPECT_EQ(worker.held().at(0).job, deadly);
    farm.remove_worker(worker.id(), "connection reset", 1s);
  }
  EXPECT_EQ(farm.job(deadly, 1s)->state, JobState::failed);
  EXPECT_NE(farm.job(deadly, 1s)->message.find("(pc1, pc2, pc3, pc4, pc5)"), std::string::npos);
  FakeWorker next(farm, pc());
  EXPECT_EQ(next.held().at(0).job, good);
}

TEST(Frames, DoNotFailBecauseOneWorkerComesAndGoesNorBecauseManyLeaveOverDifferentTiles) {
  Farm farm;
  const JobId job = farm.submit(job_of({64 * 64, 64}), 0s);
  for (int i = 0; i < 10; ++i) farm.remove_worker(FakeWorker(farm, pc(1)).id(), "connection reset", 1s);
  EXPECT_EQ(farm.job(job, 1s)->state, JobState::running);
  for (int i = 0; i < 10; ++i) {
    FakeWorker worker(farm, {.name = "pc" + std::to_string(i), .threads = 1});
    worker.finish_one(1s);
    farm.remove_worker(worker.id(), "switched off", 1s);
  }
  EXPECT_EQ(farm.job(job, 1s)->state, JobState::running);
}

}  // namespace
}  // namespace rayfarm
