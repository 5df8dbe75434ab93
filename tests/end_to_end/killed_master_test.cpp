// A master that is killed: its jobs go on where they were, with the same bytes, and nothing is rendered twice.
#include <random>

#include "master/http/client.h"
#include "tests/end_to_end/farm_programs.h"
#include "tests/support/turning_scene.h"

namespace rayfarm {
namespace {

class KilledMaster : public FarmPrograms {
 protected:
  void start() { start_master({"--threads", "0", "--state", folder / "state"}); }
  /// The workers find it where it was.
  void start_again() { start_master({"--threads", "0", "--state", folder / "state"}, farm_address()); }
  std::uint64_t pixels_delivered() const {
    std::uint64_t pixels = 0;
    for (const auto& worker : workers()) pixels += worker.at("pixels").get<std::uint64_t>();
    return pixels;
  }

  const Words picture{scene_file("circus"), "--size", "320x240", "--spp", "4"};
};

TEST_F(KilledMaster, GoesOnWithWhatWasDone) {
  const std::string expected = rendered_here(picture);
  start();
  start_worker("pc0"), start_worker("pc1");
  std::mt19937 random(1);
  for (int turn = 0; turn < 5; ++turn) {
    SCOPED_TRACE(turn);
    wait_for_workers(2);
    const std::string id = submit(picture);
    const std::uint64_t enough = random() % (320 * 240);
    std::uint64_t seen = 0;
    wait_until("enough of it is there", [&] { return (seen = pixels_of(id)) >= enough; });
    kill_master();
    start_again();
    EXPECT_GE(pixels_of(id), seen) << "what people saw done is done";
    wait_for_workers(2);
    wait_for_state(id, "done");
    EXPECT_TRUE(fetched(id) == expected);
    EXPECT_LE(pixels_delivered(), 320 * 240 - seen) << "what was done is not rendered again";
  }
}

TEST_F(KilledMaster, IsHandedWhatItsWorkersFinishedMeanwhile) {
  const Words slow{scene_file("circus"), "--size", "256x192", "--spp", "256"};
  const std::string expected = rendered_here(slow);
  start();
  start_worker("pc0"), start_worker("pc1");
  wait_for_workers(2);
  const std::string id = submit(slow);
  wait_until("both have work", [&] { return leases_of("pc0") > 1 && leases_of("pc1") > 1; });
  kill_master();
  start_again();
  for (const char* name : {"pc0", "pc1"})
    wait_until("a worker offers what it has",
               [&] { return log_of(name).find("tiles are still here") != std::string::npos; });
  wait_for_state(id, "done");
  EXPECT_TRUE(fetched(id) == expected);
  EXPECT_NE(log_of("master").find("that it held"), std::string::npos);
}

TEST_F(KilledMaster, IsWaitedForByWhoSubmitsFrames) {
  put_content(folder / "turning.lua", turning_scene);
  const Words frames{folder / "turning.lua", "--frames", "0-20", "--size", "64x64", "--spp", "4"};
  const ProgramResult here = rayfarm(Words{"render"} + frames + Words{"-o", folder / "here.##.exr"});
  ASSERT_EQ(here.exit_code, 0) << here.err;

  start();
  start_worker("pc0");
  wait_for_workers(1);
  const std::string url = http();
  ChildProgram submission(Words{"rayfarm", "submit"} + frames + Words{"-o", folder / "farm.##.exr", "--wait"},
                          {{"RAYFARM_MASTER", url}});
  const std::string id = submission.next_line();
  wait_until("some frames have come", [&] { return job(id).at("frames").at("sent") >= 3; });
  kill_master();
  start_master({"--threads", "0", "--state", folder / "state", "--http", url.substr(url.rfind('/') + 1)},
               farm_address());
  const ProgramResult submitted = submission.result();
  EXPECT_EQ(submitted.exit_code, 0) << submitted.err;
  for (const char* frame : {"00", "01", "07", "19", "20"})
    EXPECT_TRUE(content_of(folder / (std::string("here.") + frame + ".exr")) ==
                content_of(folder / (std::string("farm.") + frame + ".exr")))
        << frame;
}

TEST_F(KilledMaster, SuspendsAJobThatWasLiveAtTwoCrashesAndNamesIt) {
  start();
  start_worker("pc0");
  wait_for_workers(1);
  const std::string id = submit({scene_file("circus"), "--size", "1920x1080", "--spp", "64"});
  for (int crash = 0; crash < 2; ++crash) {
    wait_for_state(id, "running");
    kill_master();
    start_again();
  }
  EXPECT_EQ(state_of(id), "paused");
  EXPECT_NE(log_of("master").find("job " + id), std::string::npos);
  EXPECT_EQ(rayfarm({"resume", id}).exit_code, 0);
  wait_for_state(id, "running");
}

TEST_F(KilledMaster, KeepsPicturesThatAreDoneAfterACleanEndToo) {
  const std::string expected = rendered_here(picture);
  start();
  start_worker("pc0");
  const std::string id = submit(picture, {"--wait"});
  kill_all();
  start();
  EXPECT_EQ(state_of(id), "done");
  EXPECT_TRUE(fetched(id) == expected);
}

TEST_F(KilledMaster, GoesOnBringingTheFramesOfAScript) {
  put_content(folder / "turning.lua", turning_scene);
  const Words frames{folder / "turning.lua", "--frames", "0-20", "--size", "64x64", "--spp", "1"};
  const ProgramResult here = rayfarm(Words{"render"} + frames + Words{"-o", folder / "here.##.exr"});
  ASSERT_EQ(here.exit_code, 0) << here.err;

  start();
  start_worker("pc0");
  const nlohmann::json wish{{"script", turning_scene},
                            {"script_name", "turning.lua"},
                            {"frames", {{"first", 0}, {"last", 20}}},
                            {"settings", {{"width", 64}, {"height", 64}, {"spp", 1}}}};
  const HttpReply reply =
      send({.method = "POST", .url = http(), .target = "/api/v1/jobs", .body = wish.dump()});
  ASSERT_EQ(reply.status, 201u) << reply.body;
  const std::string id = nlohmann::json::parse(reply.body).at("id").dump();
  wait_until("some frames have come", [&] { return job(id).at("frames").at("sent") >= 3; });
  kill_master();
  start_again();
  wait_for_state(id, "done");
  const ProgramResult fetch = rayfarm({"fetch", id, "-o", folder / "farm.##.exr"});
  ASSERT_EQ(fetch.exit_code, 0) << fetch.err;
  for (const char* frame : {"00", "01", "07", "19", "20"})
    EXPECT_TRUE(content_of(folder / (std::string("here.") + frame + ".exr")) ==
                content_of(folder / (std::string("farm.") + frame + ".exr")))
        << frame;
}

}  // namespace
}  // namespace rayfarm
