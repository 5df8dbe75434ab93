// Meshes and images of scenes: sent once a worker, whatever number of jobs and frames show them.
#include <gtest/gtest.h>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

WorkerInfo remote(const char* name) { return {.name = name, .address = {}, .cpu = {}, .version = {}}; }

AssetData asset(char digit, std::size_t bytes = 5) {
  return {std::string(64, digit), std::make_shared<const std::vector<std::uint8_t>>(bytes, std::uint8_t{1})};
}

JobSpec job_with(std::vector<AssetData> assets, std::string scene) {
  JobSpec spec = job_of({64, 64}, "picture", std::move(scene));
  spec.assets = std::move(assets);
  return spec;
}

/// The hashes of what was sent, and with a minus of what shall be forgotten.
std::string told_of(const std::vector<ToWorker>& messages) {
  std::string told;
  for (const ToWorker& message : messages) {
    if (const auto* data = std::get_if<AssetData>(&message)) told += data->hash[0];
    if (const auto* end = std::get_if<AssetEnd>(&message))
      for (const std::string& hash : end->hashes) told += std::string("-") + hash[0];
  }
  return told;
}

TEST(FarmAssets, OneOfTwoJobsIsSentOnceAWorkerAndForgottenWithTheLast) {
  Farm farm;
  FakeWorker first(farm, remote("one")), second(farm, remote("two"));
  farm.submit(job_with({asset('a'), asset('b')}, "scene 1"), 0s);
  EXPECT_EQ(told_of(first.take_messages()), "ab");
  farm.submit(job_with({asset('a'), asset('c')}, "scene 2"), 0s);
  first.finish_one();  // scene 1
  EXPECT_EQ(told_of(second.take_messages()), "ac");
  second.finish_all();
  EXPECT_EQ(told_of(first.take_messages()), "-b-a") << "the first job's own when it ended";
  EXPECT_EQ(told_of(second.take_messages()), "-a-c");
}

TEST(FarmAssets, TheNextFramesUseThoseOfTheFirst) {
  Farm farm;
  FakeWorker worker(farm, remote("one"));
  JobSpec spec = job_with({asset('a')}, "scene 0");
  spec.frames = FrameRange{0, 2, 1};
  const JobId job = farm.submit(spec, 0s);
  worker.finish_all();  // the frame is done before the next one's scene has come
  for (const std::uint32_t frame : {1u, 2u}) {
    EXPECT_TRUE(
        farm.add_frame({job, frame}, "scene " + std::to_string(frame), spec.scene_bytes, 0s, {asset('a')}));
    worker.finish_all();
  }
  EXPECT_EQ(told_of(worker.take_messages()), "a-a");
  EXPECT_EQ(farm.assets(job, 1).size(), 1u);
}

TEST(FarmAssets, CountAmongTheBytesOfUnfinishedJobsOnce) {
  Farm farm({.scene_bytes = 6 + 100});
  farm.submit(job_with({asset('a', 100)}, "scene 1"), 0s);
  farm.submit(job_with({asset('a', 100)}, "scene 2"), 0s);
  EXPECT_THROW(farm.submit(job_with({asset('b', 100)}, "scene 1"), 0s), FarmFull);
}

}  // namespace
}  // namespace rayfarm
