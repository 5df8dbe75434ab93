// Workers that die, hang and leave: the picture is complete, with the same bytes.
#include <signal.h>

#include <algorithm>
#include <random>

#include "tests/end_to_end/each_scene.h"

namespace rayfarm {
namespace {

class LostWorkers : public EachScene {};

TEST_P(LostWorkers, KilledAtRandomInstantsChangeNoByte) {
  const std::string expected = rendered_here(picture());
  start_master({"--threads", "0"});
  start_workers_to_kill();
  std::uint64_t given_back = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    const std::string id = submit(picture());
    kill_workers(id, random);
    wait_for_state(id, "done");
    EXPECT_TRUE(fetched(id) == expected);
    given_back += job(id).at("tiles_given_back").get<std::uint64_t>();
  }
  EXPECT_GT(given_back, 20u) << "too few were killed in the middle of their work";
}

INSTANTIATE_TEST_SUITE_P(AllScenes, LostWorkers, testing::ValuesIn(five_scenes()), name_of_case);

class OneTile : public EachScene {};

TEST_P(OneTile, SharedByAllChangesNoByteAndNoCounterAlsoWhenWorkersDie) {
  Words one_tile = picture();
  *std::next(std::ranges::find(one_tile, "--size")) = "64x64";
  *std::next(std::ranges::find(one_tile, "--spp")) = "64";
  const std::string expected = rendered_here(one_tile);
  const auto counted = nlohmann::json::parse(rayfarm(Words{"stats"} + one_tile + Words{"--json"}).out);
  start_master({"--threads", "0"});
  start_workers_to_kill();
  int shared = 0;
  for (unsigned seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    wait_for_workers(3);
    const std::string id = submit(one_tile);
    kill_workers(id, random);
    wait_for_state(id, "done");
    EXPECT_TRUE(fetched(id) == expected);
    EXPECT_EQ(job(id).at("counters"), counted.at("counters"));
    shared += job(id).at("tiles_shared").get<int>();
  }
  EXPECT_GE(shared, 5);
}

INSTANTIATE_TEST_SUITE_P(AllScenes, OneTile, testing::ValuesIn(five_scenes()), name_of_case);

/// Two workers of one thread, and a picture that takes them a second or two.
class TwoWorkers : public FarmPrograms {
 protected:
  TwoWorkers() {
    start_master({"--threads", "0"});
    start_worker("pc0");
    start_worker("pc1");
    wait_for_workers(2);
  }
  /// Submits, and waits until both have delivered something of it and hold more.
  std::string job_at_work() {
    const std::string id = submit(picture);
    wait_until("both workers are at work on job " + id,
               [&] { return worker_view("pc0").at("tiles") > 0 && worker_view("pc1").at("tiles") > 0; });
    EXPECT_EQ(state_of(id), "running") << "the picture is too small for this test";
    return id;
  }

  const Words picture{scene_file("circus"), "--size", "640x480", "--spp", "16"};
};

TEST_F(TwoWorkers, WhatAHangingOneHeldIsRenderedByTheOtherAndItComesBack) {
  const std::string id = job_at_work();
  worker("pc0").send_signal(SIGSTOP);
  wait_for_state(id, "done");
  EXPECT_TRUE(fetched(id) == rendered_here(picture));
  EXPECT_GT(job(id).at("tiles_given_back").get<int>() + job(id).at("tiles_doubled").get<int>(), 0);
  wait_until("pc0 is given up",
             [&] { return log_of("master").find("worker pc0 lost") != std::string::npos; });

  worker("pc0").send_signal(SIGCONT);
  wait_until("pc0 is here again", [&] { return is_here("pc0"); });
  const std::string next = job_at_work();
  wait_for_state(next, "done");
  EXPECT_TRUE(fetched(next) == fetched(id));
}

TEST_F(TwoWorkers, OneThatIsStoppedHandsBackWhatItHasNotBegun) {
  const std::string id = job_at_work();
  worker("pc0").send_signal(SIGTERM);
  EXPECT_EQ(worker("pc0").result().exit_code, 0);
  wait_for_workers(1);
  const std::string log = log_of("master");
  EXPECT_NE(log.find("worker pc0 gave back"), std::string::npos);
  EXPECT_NE(log.find("worker pc0 left"), std::string::npos);
  EXPECT_EQ(log.find("worker pc0 lost"), std::string::npos);
  wait_for_state(id, "done");
  EXPECT_TRUE(fetched(id) == rendered_here(picture));
}

TEST_F(TwoWorkers, AreToldThatTheMasterStopsAndComeBackToTheNext) {
  const std::string lost = job_at_work(), address = farm_address();
  master().send_signal(SIGTERM);
  EXPECT_EQ(master().result().exit_code, 0);
  start_master({"--threads", "0"}, address);
  wait_for_workers(2);
  for (const char* name : {"pc0", "pc1"})
    EXPECT_NE(log_of(name).find("goodbye: the master stops"), std::string::npos) << name;
  const std::string id = job_at_work();
  wait_for_state(id, "done");
  EXPECT_TRUE(fetched(id) == rendered_here(picture));
}

TEST_F(TwoWorkers, ComeBackAlsoWhenTheMasterWasKilled) {
  const std::string lost = job_at_work(), address = farm_address();
  master().send_signal(SIGKILL);
  EXPECT_EQ(master().result().exit_code, 128 + SIGKILL);
  start_master({"--threads", "0"}, address);
  wait_for_workers(2);
  const std::string id = job_at_work();
  wait_for_state(id, "done");
  EXPECT_TRUE(fetched(id) == rendered_here(picture));
}

}  // namespace
}  // namespace rayfarm
