// The commands that ask a master: a real server before a real farm, with workers that are lambdas.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "tests/support/child_program.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_server.h"

namespace rayfarm {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

const std::string scene = RAYFARM_SOURCE_DIR "/scenes/sphere_plane.lua";

class FarmCommands : public testing::Test {
 protected:
  Words with_options(Words words) {
    for (const char* option : {"--size", "96x80", "--spp", "4"}) words.push_back(option);
    return words;
  }
  ProgramResult rayfarm(Words words) {
    words.insert(words.begin(), "rayfarm");
    return run_program(std::move(words), environment);
  }
  /// The job's id.
  std::string submit(const Words& more = {}) {
    Words words = with_options({"submit", scene, "-o", folder / "out.exr"});
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = rayfarm(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out.substr(0, result.out.find('\n'));
  }
  json job(const std::string& id) { return json::parse(rayfarm({"job", id, "--json"}).out); }

  ScratchFolder folder;
  FarmThread farm;
  TestServer server{door_to(farm)};
  std::map<std::string, std::string> environment{{"RAYFARM_MASTER", server.url()}};
};

TEST_F(FarmCommands, TheFarmsFileIsTheLocalFile) {
  farm.add_renderer("pc1");
  ASSERT_EQ(rayfarm(with_options({"render", scene, "-o", folder / "local.exr"})).exit_code, 0);
  ASSERT_EQ(rayfarm(with_options({"render", scene, "-o", folder / "local.png"})).exit_code, 0);
  const std::string id = submit({"--wait"});
  EXPECT_EQ(content_of(folder / "out.exr"), content_of(folder / "local.exr"));
  EXPECT_EQ(rayfarm({"fetch", id, "-o", folder / "fetched.exr"}).exit_code, 0);
  EXPECT_EQ(content_of(folder / "fetched.exr"), content_of(folder / "local.exr"));
  EXPECT_EQ(rayfarm({"fetch", id, "-o", folder / "fetched.png"}).exit_code, 0);
  EXPECT_EQ(content_of(folder / "fetched.png"), content_of(folder / "local.png"));
}

TEST_F(FarmCommands, FetchWritesTheJobsOutputUnlessToldOtherwise) {
  farm.add_renderer("pc1");
  const std::string id = submit();
  EXPECT_EQ(rayfarm({"watch", id}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
  EXPECT_EQ(rayfarm({"fetch", id}).out, (folder / "out.exr").string() + "\n");
  EXPECT_TRUE(std::filesystem::exists(folder / "out.exr"));
}

TEST_F(FarmCommands, SubmitSendsTheSettingsNameAndPriority) {
  const json sent =
      job(submit({"--name", "mine", "--priority", "7", "--hold", "--seed", "9", "--no-shadows"}));
  EXPECT_EQ(sent["name"], "mine");
  EXPECT_EQ(sent["priority"], 7);
  EXPECT_EQ(sent["state"], "paused");
  EXPECT_EQ(sent["settings"]["seed"], 9);
  EXPECT_EQ(sent["settings"]["shadows"], false);
  EXPECT_EQ(job(submit())["name"], "sphere_plane");
}

TEST_F(FarmCommands, TheSameKeyIsTheSameJob) {
  EXPECT_EQ(submit({"--id", "k"}), submit({"--id", "k"}));
  EXPECT_NE(submit({"--id", "k"}), submit({"--id", "l"}));
}

TEST_F(FarmCommands, APartialPictureIsWrittenOnRequestAndSaidToBePartial) {
  farm.add_renderer("pc1", 1);
  const std::string id = submit();
  put_content(folder / "out.exr", "old");
  while (job(id)["pixels_done"] == 0) std::this_thread::yield();
  EXPECT_EQ(rayfarm({"fetch", id}).exit_code, 1);
  EXPECT_EQ(content_of(folder / "out.exr"), "old");
  const ProgramResult partial = rayfarm({"fetch", id, "--partial"});
  EXPECT_EQ(partial.exit_code, 7);
  EXPECT_NE(content_of(folder / "out.exr"), "old");
}

TEST_F(FarmCommands, AJobIsPausedResumedPrioritisedAndCancelled) {
  const std::string id = submit();
  EXPECT_EQ(rayfarm({"pause", id}).out, "job " + id + " is paused, priority 50\n");
  EXPECT_EQ(rayfarm({"priority", id, "99"}).out, "job " + id + " is paused, priority 99\n");
  EXPECT_EQ(rayfarm({"resume", id}).exit_code, 0);
  EXPECT_EQ(json::parse(rayfarm({"cancel", id, "--json"}).out)["state"], "cancelled");
  EXPECT_EQ(rayfarm({"cancel", id}).exit_code, 1);
  EXPECT_EQ(rayfarm({"watch", id}).exit_code, 1);
}

TEST_F(FarmCommands, AJobIsRemovedOnceItHasEnded) {
  const std::string id = submit();
  const ProgramResult early = rayfarm({"remove", id});
  EXPECT_EQ(early.exit_code, 1);
  EXPECT_NE(early.err.find("cancel it first"), std::string::npos) << early.err;
  rayfarm({"cancel", id});
  EXPECT_EQ(rayfarm({"remove", id}).out, "job " + id + ", which was cancelled, is removed\n");
  for (const std::string command : {"job", "watch", "fetch", "remove"}) {
    const ProgramResult gone = rayfarm({command, id});
    EXPECT_EQ(gone.exit_code, 1) << command;
    EXPECT_NE(gone.err.find("job " + id + " is no longer kept"), std::string::npos) << gone.err;
  }
}

TEST_F(FarmCommands, AnUnknownJobOrWorkerIsNamed) {
  for (const std::string command : {"job", "watch", "fetch", "pause", "resume", "cancel", "remove"}) {
    const ProgramResult result = rayfarm({command, "7"});
    EXPECT_EQ(result.exit_code, 1) << command;
    EXPECT_NE(result.err.find("no job 7"), std::string::npos) << result.err;
  }
  EXPECT_EQ(rayfarm({"drain", "nobody"}).exit_code, 1);
  EXPECT_NE(rayfarm({"drain", "nobody"}).err.find("no worker nobody"), std::string::npos);
}

TEST_F(FarmCommands, JobsAndWorkersAreTablesOrJson) {
  farm.add_idler("pc 1");
  const std::string id = submit({"--name", "mine"});
  EXPECT_NE(rayfarm({"jobs"}).out.find("mine"), std::string::npos);
  EXPECT_EQ(json::parse(rayfarm({"jobs", "--json"}).out)["jobs"][0]["name"], "mine");
  EXPECT_NE(rayfarm({"job", id}).out.find("mine"), std::string::npos);
  EXPECT_NE(rayfarm({"workers"}).out.find("pc 1"), std::string::npos);
  EXPECT_EQ(rayfarm({"drain", "pc 1"}).exit_code, 0);
  EXPECT_EQ(json::parse(rayfarm({"workers", "--json"}).out)["workers"][0]["state"], "drained");
  EXPECT_EQ(rayfarm({"undrain", "pc 1"}).exit_code, 0);
  EXPECT_EQ(rayfarm({"ban", "pc 1"}).exit_code, 0);
  EXPECT_NE(rayfarm({"workers"}).out.find("banned"), std::string::npos);
  EXPECT_EQ(rayfarm({"unban", "pc 1"}).exit_code, 0);
}

// The workers never answer, so the job never ends by itself.
TEST_F(FarmCommands, InterruptedTheySayThatTheJobGoesOn) {
  farm.add_idler("pc1");
  for (const Words& begin :
       {Words{"submit", scene, "-o", folder / "out.exr", "--wait"},
        Words{"submit", scene, "-o", folder / "out.exr", "--watch"}, Words{"watch", "1", "--json"}}) {
    Words words{"rayfarm"};
    words.insert(words.end(), begin.begin(), begin.end());
    ChildProgram program(words, environment);
    EXPECT_NE(program.next_line(), "");  // the id, or the first news: now it waits for the job
    program.send_signal(SIGINT);
    const ProgramResult result = program.result();
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_NE(result.err.find("goes on"), std::string::npos) << result.err;
  }
  EXPECT_EQ(job("1")["state"], "running");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

TEST_F(FarmCommands, AWaitGoesOnWhileTheMasterIsBusy) {
  farm.add_renderer("pc1");
  const std::string id = submit();
  std::atomic_flag was_busy;
  const TestServer busy([&](FarmThread::Task task) {
    if (was_busy.test_and_set()) farm.post(std::move(task));
  });
  environment["RAYFARM_MASTER"] = busy.url();
  EXPECT_EQ(rayfarm({"watch", id}).exit_code, 0);
  EXPECT_TRUE(was_busy.test());
}

TEST_F(FarmCommands, AKeyOfAnotherPictureIsNamed) {
  submit({"--id", "homework"});
  const ProgramResult other =
      rayfarm({"submit", scene, "-o", folder / "out.exr", "--id", "homework", "--seed", "7"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("homework belongs to job 1"), std::string::npos) << other.err;
}

TEST_F(FarmCommands, ACancelledJobEndsTheWaitForItAndWritesNothing) {
  ChildProgram waiting({"rayfarm", "submit", scene, "-o", folder / "out.exr", "--wait"}, environment);
  const std::string id = waiting.next_line();
  rayfarm({"cancel", id});
  const ProgramResult result = waiting.result();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("cancelled"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "out.exr"));
}

TEST_F(FarmCommands, WhatCannotBeRenderedOrWrittenIsNotSubmitted) {
  EXPECT_EQ(rayfarm({"submit", scene, "-o", folder / "a.jpg"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"submit", scene, "-o", folder / "a.exr", "--size", "0x0"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"submit", folder / "none.lua", "-o", folder / "a.exr"}).exit_code, 2);
  EXPECT_TRUE(json::parse(rayfarm({"jobs", "--json"}).out)["jobs"].empty());
}

}  // namespace
}  // namespace rayfarm
