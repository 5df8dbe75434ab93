// Pause, resume, cancel, drain, priorities, hold: commands act at once, in the middle of a slow tile too.

#include "master/files/image_file.h"
#include "tests/end_to_end/farm_programs.h"

namespace rayfarm {
namespace {

/// One worker of one thread: who holds it up holds up everybody.
class Steering : public FarmPrograms {
 protected:
  Steering() {
    start_master({"--threads", "0"});
    start_worker("pc");
    wait_for_workers(1);
  }
  /// A command that must succeed; what the job or worker then is.
  void command(const Words& words) {
    const ProgramResult result = rayfarm(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  /// Of the slow picture, begun.
  std::string slow_job() {
    const std::string id = submit(slow);
    wait_until("the worker says that it has begun", [&] {
      return log_of("pc").find("job " + id + " starts") != std::string::npos && leases_of("pc") > 0;
    });
    return id;
  }
  /// The thread is free: it would be busy for an hour with a tile of the slow picture.
  void expect_the_worker_is_free() { EXPECT_TRUE(rendered_by_farm(quick) == rendered_here(quick)); }

  const Words slow{scene_file("hedgehog_in_the_cage"), "--size", "100x64", "--spp", "1048576"};
  const Words quick{scene_file("sphere_plane"), "--size", "100x80", "--spp", "1"};
  const Words medium{scene_file("circus"), "--size", "640x480", "--spp", "9"};
};

TEST_F(Steering, ACancelledJobLetsItsWorkerGo) {
  const std::string id = slow_job();
  command({"cancel", id});
  EXPECT_EQ(state_of(id), "cancelled");
  EXPECT_EQ(worker_view("pc").at("state"), "idle");
  expect_the_worker_is_free();
}

TEST_F(Steering, APausedJobLetsItsWorkerGoAndIsResumed) {
  const std::string id = slow_job();
  command({"pause", id});
  EXPECT_EQ(state_of(id), "paused");
  EXPECT_EQ(worker_view("pc").at("state"), "idle");
  expect_the_worker_is_free();
  command({"resume", id});
  EXPECT_EQ(state_of(id), "running");
  EXPECT_EQ(worker_view("pc").at("state"), "busy");
  command({"cancel", id});
}

TEST_F(Steering, ADrainedWorkerHoldsNothingUntilItIsUndrained) {
  const std::string id = slow_job();
  command({"drain", "pc"});
  EXPECT_EQ(worker_view("pc").at("state"), "drained");
  EXPECT_EQ(leases_of("pc"), 0u);
  command({"cancel", id});
  const std::string waiting = submit(quick);
  start_worker("pc2");
  wait_for_state(waiting, "done");
  EXPECT_EQ(worker_view("pc").at("tiles"), 0) << "the other did all";

  command({"drain", "pc2"});
  command({"undrain", "pc"});
  EXPECT_EQ(worker_view("pc").at("state"), "idle");
  expect_the_worker_is_free();
}

TEST_F(Steering, ABannedWorkerIsGoneUntilItIsUnbanned) {
  slow_job();
  command({"ban", "pc"});
  wait_for_workers(0);
  command({"unban", "pc"});
  wait_for_workers(1);
}

TEST_F(Steering, APictureThatWasPausedInTheMiddleHasTheSameBytes) {
  const std::string id = submit(medium);
  wait_for_pixels(id);
  command({"pause", id});
  const std::uint64_t pixels = pixels_of(id);
  EXPECT_LT(pixels, 640u * 480u);
  expect_the_worker_is_free();
  EXPECT_EQ(pixels_of(id), pixels) << "nothing comes in while it is paused";
  command({"resume", id});
  wait_for_state(id, "done");
  EXPECT_TRUE(fetched(id) == rendered_here(medium));
}

TEST_F(Steering, TheMastersOwnThreadsObeyAsWell) {
  kill_all();
  start_master({"--threads", "1"});
  for (const std::string end : {"pause", "cancel"}) {
    const std::string id = submit(slow);
    wait_until("the master's thread is at work", [&] { return leases_of("master") > 0; });
    command({end, id});
    EXPECT_EQ(worker_view("master").at("state"), "idle");
    expect_the_worker_is_free();
  }
}

TEST_F(Steering, TheJobOfHigherPriorityIsDoneFirst) {
  command({"drain", "pc"});
  const std::string low = submit(quick, {"--priority", "10"}), middle = submit(quick),
                    high = submit(quick, {"--priority", "90"});
  command({"priority", low, "99"});
  command({"undrain", "pc"});
  for (const std::string& id : {low, middle, high}) wait_for_state(id, "done");
  const std::string log = log_of("master");
  const auto place_of = [&](const std::string& id) { return log.find("job " + id + " (sphere_plane) done"); };
  ASSERT_NE(place_of(middle), std::string::npos) << log;
  EXPECT_LT(place_of(low), place_of(high));
  EXPECT_LT(place_of(high), place_of(middle));
}

TEST_F(Steering, AJobOnHoldWaitsUntilItIsResumed) {
  const std::string held = submit(quick, {"--hold"});
  expect_the_worker_is_free();
  EXPECT_EQ(state_of(held), "paused");
  EXPECT_EQ(pixels_of(held), 0u);
  command({"resume", held});
  wait_for_state(held, "done");
}

TEST_F(Steering, TheSameKeyIsTheSameJob) {
  const std::string first = submit(quick, {"--id", "mine"});
  wait_for_state(first, "done");
  EXPECT_EQ(submit(quick, {"--id", "mine"}), first);
  EXPECT_NE(submit(quick, {"--id", "yours"}), first);
}

TEST_F(Steering, APartOfAPictureIsFetchedWhole) {
  const std::string id = submit({scene_file("circus"), "--size", "1920x1080", "--spp", "64"});
  wait_for_pixels(id);
  put_content(folder / "part.exr", "old");
  EXPECT_EQ(rayfarm({"fetch", id, "-o", folder / "part.exr"}).exit_code, 1);
  EXPECT_EQ(content_of(folder / "part.exr"), "old");
  const ProgramResult partial = rayfarm({"fetch", id, "--partial", "-o", folder / "part.exr"});
  EXPECT_EQ(partial.exit_code, 7) << partial.err;
  EXPECT_EQ(read_picture(folder / "part.exr").size, (Size{1920, 1080}));
  command({"cancel", id});
}

}  // namespace
}  // namespace rayfarm
