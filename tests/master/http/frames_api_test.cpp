// Jobs of several frames over HTTP.
#include <set>

#include "tests/master/http/api_fixture.h"

namespace rayfarm {
namespace {

using nlohmann::json;

TEST_F(Api, TheFramesOfAJobComeOneAfterTheOther) {
  JobSpec spec = small_job();
  spec.frames = FrameRange{2, 6, 2};
  const std::string job = "/api/v1/jobs/" + submit(spec);
  EXPECT_EQ(get_json(job)["frames"]["sent"], 1);
  EXPECT_EQ(get_json(job)["settings"]["frame"], 2);
  const auto send = [&](std::uint32_t frame) {
    return post(job + "/frames", to_json(SubmittedFrame{frame, {spec.scene_hash, spec.scene_bytes}, {}}))
        .status;
  };
  EXPECT_EQ(send(6), 422u) << "4 is next";
  EXPECT_EQ(send(4), 201u);
  EXPECT_EQ(send(4), 201u) << "again";
  EXPECT_EQ(send(6), 201u);
  EXPECT_EQ(send(8), 422u);
  EXPECT_EQ(post(job + "/frames", {{"frame", 4}}).status, 400u);
  EXPECT_EQ(post(job + "/frames", {{"frame", 4}, {"scene", "!"}}).status, 422u);
  EXPECT_EQ(
      post("/api/v1/jobs/77/frames", to_json(SubmittedFrame{2, {spec.scene_hash, spec.scene_bytes}, {}}))
          .status,
      404u);
  const json frames = get_json(job + "/frames")["frames"];
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[1]["frame"], 4);
  EXPECT_EQ(frames[1]["state"], "waiting");
  post(job + "/cancel");
  EXPECT_EQ(send(8), 409u);
}

TEST_F(Api, EachFrameHasItsPictureMapsAndCounts) {
  farm.add_renderer("pc1");
  JobSpec spec = small_job();
  spec.frames = FrameRange{0, 1, 1};
  const std::string id = submit(spec), job = "/api/v1/jobs/" + id;
  post(job + "/frames", to_json(SubmittedFrame{1, {spec.scene_hash, spec.scene_bytes}, {}}));
  wait_until_done(id);
  for (const std::string what : {"/film", "/picture.png", "/picture.exr", "/scene", "/trace?x=1&y=1"}) {
    const std::string joint = what.find('?') == std::string::npos ? "?" : "&";
    EXPECT_EQ(get(job + what).body.text(), get(job + what + joint + "frame=0").body.text()) << what;
    EXPECT_EQ(get(job + what + joint + "frame=1").status, 200u) << what;
    EXPECT_EQ(get(job + what + joint + "frame=2").status, 404u) << what;
    EXPECT_EQ(get(job + what + joint + "frame=x").status, 400u) << what;
  }
  EXPECT_NE(get(job + "/film?frame=0").body.text(), get(job + "/film?frame=1").body.text())
      << "the frame is part of what chance depends on";
  const json all = get_json(job + "/statistics"), one = get_json(job + "/statistics?frame=1");
  EXPECT_EQ(all["counters"]["primary"], 2 * one["counters"]["primary"].get<int>());
  EXPECT_EQ(all["detail"]["state"], "unavailable");
  EXPECT_EQ(get_json(job + "/difference/" + id + "?frame=1&other_frame=1")["max"], 0);
  EXPECT_GT(get_json(job + "/difference/" + id + "?frame=0&other_frame=1")["max"], 0);
}

TEST_F(Api, TheFramesOfAScriptAreEvaluatedByTheMaster) {
  farm.add_renderer("pc1");
  const char* script =
      "return scene{ root = sphere{}:translate(time, 0, 5), animation = { stop = 2, fps = 2 } }";
  const auto wish = [&](std::uint32_t last) {
    return json{{"script", script},
                {"frames", {{"first", 1u}, {"last", last}}},
                {"settings", {{"width", 16u}, {"height", 8u}, {"spp", 1u}}}};
  };
  EXPECT_EQ(post("/api/v1/jobs", wish(5)).status, 422u) << "the last frame is 4";
  EXPECT_EQ(post("/api/v1/jobs", wish(0)).status, 422u);
  const ApiResponse submitted = post("/api/v1/jobs", wish(4));
  ASSERT_EQ(submitted.status, 201u) << submitted.body.text();
  const std::string id = json::parse(submitted.body)["id"].dump();
  wait_until_done(id);
  std::set<std::string> scenes;
  const json listed = get_json("/api/v1/jobs/" + id + "/frames");
  for (const json& frame : listed["frames"]) scenes.insert(frame["scene_hash"]);
  EXPECT_EQ(scenes.size(), 4u);

  const json like = {{"scene_of", std::stoull(id)}, {"settings", {{"frame", 3u}}}};
  const json still = json::parse(post("/api/v1/jobs", like).body);
  EXPECT_EQ(still["scene_hash"], get_json("/api/v1/jobs/" + id + "/frames")["frames"][2]["scene_hash"]);
  EXPECT_EQ(still["frames"]["total"], 1);
  EXPECT_EQ(still["settings"]["frame"], 3);
}

TEST_F(Api, TheFramesOfAScriptComeAlsoWhenItsOrderIsNotOnTheDiskYet) {
  farm.add_renderer("pc1");
  until_synced = [] { return "the disk is slow"; };
  const json wish{{"script", "return scene{ root = sphere{}, animation = { stop = 2, fps = 2 } }"},
                  {"frames", {{"first", 0u}, {"last", 3u}}},
                  {"settings", {{"width", 16u}, {"height", 8u}, {"spp", 1u}}}};
  EXPECT_EQ(post("/api/v1/jobs", wish).status, 507u);
  wait_until_done("1");
}

TEST_F(Api, AScriptThatFailsInALaterFrameFailsItsJobAndSaysWhich) {
  const json wish = {
      {"script", "return scene{ root = sphere{}:scale(2 - time), animation = { stop = 3, fps = 1 } }"},
      {"frames", {{"first", 0u}, {"last", 3u}}}};
  const std::string id = json::parse(post("/api/v1/jobs", wish).body)["id"].dump();
  while (get_json("/api/v1/jobs/" + id)["state"] != "failed") std::this_thread::yield();
  const std::string message = get_json("/api/v1/jobs/" + id)["message"];
  EXPECT_TRUE(message.starts_with("frame 2: script.lua:1")) << message;
}

}  // namespace
}  // namespace rayfarm
