// How a job's picture came about, asked of real daemons: what the commands make of the same scene without them.
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "master/http/client.h"
#include "tests/end_to_end/farm_programs.h"

namespace rayfarm {
namespace {

using nlohmann::json;

/// The master's own thread and a worker share the picture.
class JobDiagnostics : public FarmPrograms {
 protected:
  JobDiagnostics() {
    start_master({"--threads", "1"});
    start_worker("pc");
    wait_for_workers(2);
  }
  std::string out_of(const Words& words) {
    const ProgramResult result = rayfarm(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }
  /// The file that the command writes.
  std::string file_of(const Words& words, const std::string& ending) {
    const std::string file = folder / ("made" + ending);
    out_of(words + Words{"-o", file});
    const std::string content = content_of(file);
    std::filesystem::remove(file);
    return content;
  }
  void expect_equal_map(const std::string& job, const Words& map, const std::string& ending) {
    const Words command = Words{"map"} + map;
    EXPECT_TRUE(file_of(command + Words{"--job", job}, ending) == file_of(command + picture, ending))
        << map[0] << ending;
  }
  void expect_equal_trace(const std::string& job, const Words& pixel) {
    EXPECT_EQ(out_of(Words{"trace", "--job", job} + pixel), out_of(Words{"trace"} + picture + pixel));
  }
  void expect_refusal(const Words& words, int code, const std::string& message) {
    const ProgramResult result = rayfarm(words);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  }

  const Words picture{scene_file("circus"), "--size", "160x120", "--spp", "4"};
  const Words slow{scene_file("hedgehog_in_the_cage"), "--size", "100x64", "--spp", "1048576"};
};

TEST_F(JobDiagnostics, MapsAndTracesAreThoseOfTheSceneBeforeWhileAndAfterItIsRendered) {
  const std::string id = submit(picture, {"--hold"});
  expect_equal_map(id, {"depth"}, ".exr");
  expect_equal_trace(id, {"--pixel", "80,60", "--sample", "all"});
  out_of({"resume", id});
  expect_equal_map(id, {"normal", "--reduce", "mean"}, ".csv");
  expect_equal_trace(id, {"--pixel", "79,61", "--json"});
  wait_for_state(id, "done");
  expect_equal_map(id, {"all-rays", "--compat", "--range", "0,20", "--scale", "perceptual"}, ".png");
  expect_equal_trace(id, {"--pixel", "0,119", "--sample", "centre"});
  const Words pixel{"--pixel", "80,60"};
  EXPECT_EQ(file_of(Words{"trace", "--job", id} + pixel, ".svg"),
            file_of(Words{"trace"} + picture + pixel, ".svg"));
}

TEST_F(JobDiagnostics, StatisticsAreThoseOfTheScene) {
  const std::string id = submit(picture, {"--wait"});
  const json farm = json::parse(out_of({"stats", "--job", id, "--json"}));
  const json here = json::parse(out_of(Words{"stats", "--json"} + picture));
  for (const auto& [name, total] : here["counters"].items()) EXPECT_EQ(farm["counters"][name], total) << name;
  EXPECT_EQ(farm["detail"]["hits"], here["hits"]);
  const std::string table = out_of({"stats", "--job", id});
  for (const char* word : {"primary", "lost rays", "SOLIDS TESTED", "SOLID ", "waiting"})
    EXPECT_NE(table.find(word), std::string::npos) << table;
}

TEST_F(JobDiagnostics, WhoRenderedThePixelsIsTold) {
  const std::string id = submit(picture, {"--wait"});
  std::istringstream table(file_of({"map", "worker", "--job", id}, ".csv"));
  std::string title, row;
  std::getline(table, title);
  EXPECT_TRUE(title.find("master") != std::string::npos || title.find("pc") != std::string::npos) << title;
  int rows = 0;
  for (; std::getline(table, row); ++rows) EXPECT_EQ(row.find_first_not_of("01;"), std::string::npos) << row;
  EXPECT_EQ(rows, 120);
  EXPECT_FALSE(file_of({"map", "cost", "--job", id}, ".exr").empty());
}

TEST_F(JobDiagnostics, TheCloudHasAtMostThePointsThatWereAskedFor) {
  const std::string id = submit(picture, {"--hold"});
  const std::string cloud = file_of({"cloud", "--job", id, "--points", "1000", "--ascii"}, ".ply");
  EXPECT_TRUE(cloud.starts_with("ply\nformat ascii")) << cloud.substr(0, 200);
  const std::string points = cloud.substr(cloud.find("end_header\n") + 11);
  EXPECT_EQ(std::ranges::count(points, '\n'), 1000);
}

TEST_F(JobDiagnostics, WhatIsNotThereIsNamed) {
  const std::string id = submit(picture, {"--hold"});
  expect_refusal({"trace", "--job", id, "--pixel", "160,0"}, 2, "159,119");
  expect_refusal({"trace", "--job", id, "--pixel", "1,1", "--sample", "4"}, 2, "from 0 to 3");
  out_of({"cancel", id});
  const std::string file = folder / "a.png";
  expect_refusal({"map", "depth", "--job", id, "-o", file}, 1, "was cancelled");
  expect_refusal({"trace", "--job", id, "--pixel", "1,1"}, 1, "was cancelled");
  expect_refusal({"map", "depth", "--job", "77", "-o", file}, 1, "no job 77");
  expect_refusal({"map", "depth", "-o", file}, 2, "SCENE or --job");
  expect_refusal({"map", "depth", scene_file("circus"), "--job", id, "-o", file}, 2, "--job");
  expect_refusal({"stats", "--job", id, "--spp", "4"}, 2, "--job");
  EXPECT_FALSE(std::filesystem::exists(file));
}

// The counters once waited for the whole picture to be traced again.
TEST_F(JobDiagnostics, WhatIsKnownOfAJobThatRendersIsToldAtOnce) {
  const std::string id = submit(slow);
  const std::string text = out_of({"stats", "--job", id});
  for (const char* word : {"primary", "lost rays", "waiting", "wait for them with --wait"})
    EXPECT_NE(text.find(word), std::string::npos) << text;
  EXPECT_EQ(json::parse(out_of({"stats", "--job", id, "--json"}))["detail"]["state"], "making");
  const std::string file = folder / "part.csv";
  expect_refusal({"map", "all-rays", "--job", id, "--partial", "-o", file}, 7, "of the pixels were there");
  const std::string part = content_of(file);
  EXPECT_EQ(std::ranges::count(part, '\n'), 65);
  out_of({"cancel", id});  // it would leave little time for what comes
  const std::string held = submit(picture, {"--hold"});
  const std::string whole = file_of({"map", "depth", "--job", held}, ".csv");
  EXPECT_EQ(file_of({"map", "depth", "--job", held, "--partial"}, ".csv"), whole);
}

TEST_F(JobDiagnostics, AStoppingMasterDoesNotWaitForWhatItMakes) {
  const std::string id = submit(slow);
  for (const char* what : {"/maps/all-rays", "/statistics"})
    EXPECT_EQ(send({.url = http(), .target = "/api/v1/jobs/" + id + what, .body = {}}).status, 202u);
  master().send_signal(SIGTERM);
  EXPECT_EQ(master().result().exit_code, 0);
}

}  // namespace
}  // namespace rayfarm
