// Frames of one job, by real programs: whoever renders them, and whoever dies meanwhile, they have the same bytes.
#include <random>
#include <thread>

#include "master/http/client.h"
#include "tests/end_to_end/farm_programs.h"
#include "tests/support/turning_scene.h"

namespace rayfarm {
namespace {

using nlohmann::json;

class Animation : public FarmPrograms {
 protected:
  Animation() { put_content(folder / "turning.lua", turning_scene); }

  Words frames() const {
    return {folder / "turning.lua", "--frames", "0-20:2", "--size", "200x150", "--spp", "4"};
  }
  json rendered_frames_here() const {
    const ProgramResult result =
        rayfarm(Words{"render"} + frames() + Words{"-o", folder / "here.##.exr", "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out);
  }
  void expect_same_files() {
    for (const char* frame : {"00", "02", "04", "06", "08", "10", "12", "14", "16", "18", "20"})
      EXPECT_TRUE(content_of(folder / (std::string("here.") + frame + ".exr")) ==
                  content_of(folder / (std::string("farm.") + frame + ".exr")))
          << frame;
  }
  /// Each of the three in turn, at random instants, until the job is done.
  void kill_workers_while_it_runs(const std::string& id, std::mt19937& random) {
    for (int kills = 0; kills < 12 && state_of(id) != "done"; ++kills) {
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % 60));  // nothing is waited for
      const std::string victim = "pc" + std::to_string(kills % 3);
      kill_worker(victim);
      start_worker(victim);
    }
  }
};

TEST_F(Animation, HasTheBytesAndCountsOfALocalOneWhoeverIsKilled) {
  const json here = rendered_frames_here();
  start_master({"--threads", "0"});
  for (const char* name : {"pc0", "pc1", "pc2"}) start_worker(name);
  std::uint64_t given_back = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::mt19937 random(seed);
    const ProgramResult submitted = rayfarm(Words{"submit"} + frames() + Words{"-o", folder / "farm.##.exr"});
    ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
    const std::string id = submitted.out.substr(0, submitted.out.find('\n'));
    kill_workers_while_it_runs(id, random);
    wait_for_state(id, "done");
    ASSERT_EQ(rayfarm({"fetch", id}).exit_code, 0);
    expect_same_files();
    EXPECT_EQ(job(id).at("counters"), here.at("counters"));
    const json views = ask("/api/v1/jobs/" + id + "/frames").at("frames");
    ASSERT_EQ(views.size(), 11u);
    for (std::size_t i = 0; i < views.size(); ++i)
      EXPECT_EQ(views[i].at("counters"), here.at("frames")[i].at("counters"));
    given_back += job(id).at("tiles_given_back").get<std::uint64_t>();
  }
  EXPECT_GT(given_back, 4u) << "too few were killed in the middle of their work";
}

TEST_F(Animation, ComesFromAScriptThatTheMasterEvaluatesToo) {
  rendered_frames_here();
  start_master({"--threads", "1"});
  const json wish{{"script", turning_scene},
                  {"frames", {{"first", 0}, {"last", 20}, {"step", 2}}},
                  {"settings", {{"width", 200}, {"height", 150}, {"spp", 4}}}};
  const HttpReply reply =
      send({.method = "POST", .url = http(), .target = "/api/v1/jobs", .body = wish.dump()});
  ASSERT_EQ(reply.status, 201u) << reply.body;
  const std::string id = json::parse(reply.body).at("id").dump();
  wait_for_state(id, "done");
  ASSERT_EQ(rayfarm({"fetch", id, "-o", folder / "farm.##.exr"}).exit_code, 0);
  expect_same_files();
}

}  // namespace
}  // namespace rayfarm
