#include "master/http/api.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "master/http/submission.h"
#include "tests/support/test_server.h"
#include "tests/support/test_submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

class Api : public testing::Test {
 protected:
  ApiResponse get(const std::string& target) {
    return answer({"GET", target, "", "", "", "", ""},
                  {.farm = door, .diagnostics = diagnostics, .master = master, .app = app, .scenes = scenes});
  }
  ApiResponse post(const std::string& target, const json& body = json::object()) {
    return answer({"POST", target, "", "", "", "", body.dump()},
                  {.farm = door, .diagnostics = diagnostics, .master = master, .app = app, .scenes = scenes});
  }
  json get_json(const std::string& target) { return json::parse(get(target).body); }
  std::string submit(const JobSpec& spec = small_job()) {
    return json::parse(post("/api/v1/jobs", to_json(spec)).body)["id"].dump();
  }
  void wait_until_done(const std::string& id) {
    while (get_json("/api/v1/jobs/" + id)["state"] != "done") std::this_thread::yield();
  }

  FarmThread farm;
  FarmDoor door{[this](FarmThread::Task task) { farm.post(std::move(task)); }};
  Diagnostics diagnostics{1};
  MasterDoor master = lone_master();
  const AppFiles app;
  const SceneLibrary scenes;
};

TEST_F(Api, ASubmittedJobIsListedAndShownWithItsSettings) {
  const ApiResponse submitted = post("/api/v1/jobs", to_json(small_job()));
  EXPECT_EQ(submitted.status, 201u);
  const json job = json::parse(submitted.body);
  EXPECT_EQ(job["name"], "small");
  EXPECT_EQ(job["output"], "small.exr");
  EXPECT_EQ(job["scene_hash"], small_job().scene_hash);
  EXPECT_EQ(job["settings"]["width"], 96);
  EXPECT_EQ(job["pixels_total"], 96 * 80);
  EXPECT_EQ(get_json("/api/v1/jobs")["jobs"].size(), 1u);
  EXPECT_EQ(get_json("/api/v1/jobs/" + job["id"].dump())["name"], "small");
}

TEST_F(Api, TheFilmOfADoneJobIsTheFarms) {
  farm.add_renderer("pc1");
  const std::string id = submit();
  wait_until_done(id);
  const ApiResponse response = get("/api/v1/jobs/" + id + "/film");
  ASSERT_EQ(response.status, 200u);
  const Film film =
      decode_film({reinterpret_cast<const std::uint8_t*>(response.body.data()), response.body.size()});
  EXPECT_TRUE(film.is_complete());
  farm.run([&](Farm& f, FarmTime) { EXPECT_EQ(f.film(JobId{std::stoull(id)})->rgb(), film.rgb()); });
  const ApiResponse picture = get("/api/v1/jobs/" + id + "/picture.png");
  EXPECT_EQ(picture.content_type, "image/png");
  EXPECT_EQ(picture.body.text().substr(1, 3), "PNG");
}

TEST_F(Api, AJobIsPausedResumedPrioritisedAndCancelled) {
  const std::string job = "/api/v1/jobs/" + submit();
  EXPECT_EQ(json::parse(post(job + "/pause").body)["state"], "paused");
  EXPECT_NE(json::parse(post(job + "/resume").body)["state"], "paused");
  EXPECT_EQ(json::parse(post(job + "/priority", {{"priority", 77}}).body)["priority"], 77);
  EXPECT_EQ(json::parse(post(job + "/cancel").body)["state"], "cancelled");
  EXPECT_EQ(post(job + "/cancel").status, 409u);
  EXPECT_EQ(post(job + "/pause").status, 409u);
  EXPECT_EQ(post(job + "/priority", {{"priority", 100}}).status, 400u);
  EXPECT_EQ(post(job + "/priority").status, 400u);
}

TEST_F(Api, AWorkerIsListedDrainedAndUndrained) {
  farm.add_idler("pc 7/ä");
  EXPECT_EQ(get_json("/api/v1/workers")["workers"][0]["name"], "pc 7/ä");
  EXPECT_EQ(post("/api/v1/workers/pc%207%2F%C3%A4/drain").status, 200u);
  EXPECT_EQ(get_json("/api/v1/workers")["workers"][0]["state"], "drained");
  EXPECT_EQ(post("/api/v1/workers/pc%207%2F%C3%A4/undrain").status, 200u);
  EXPECT_EQ(get_json("/api/v1/workers")["workers"][0]["state"], "idle");
  EXPECT_EQ(post("/api/v1/workers/nobody/drain").status, 404u);
}

// A worker's name comes from its own machine and need not be UTF-8; the list must still be JSON.
TEST_F(Api, AWorkerWithABrokenNameDoesNotBreakTheList) {
  farm.add_idler("pc\xff");
  EXPECT_EQ(get("/api/v1/workers").status, 200u);
  EXPECT_TRUE(get_json("/api/v1/workers")["workers"][0]["name"].is_string());
}

TEST_F(Api, WhatIsNotThereIs404AndAWrongMethod405) {
  EXPECT_EQ(get("/api/v1/jobs/7").status, 404u);
  EXPECT_EQ(get("/api/v1/jobs/7/film").status, 404u);
  EXPECT_EQ(post("/api/v1/jobs/7/pause").status, 404u);
  EXPECT_EQ(get("/api/v1/jobs/seven").status, 400u);
  EXPECT_EQ(get("/api/v1/jobs/-1").status, 400u);
  EXPECT_EQ(get("/api/v1/nothing").status, 404u);
  EXPECT_EQ(get("/../../etc/passwd").status, 404u);
  EXPECT_EQ(get("/%").status, 400u);
  EXPECT_EQ(get("/api/v1/jobs/7/pause").status, 405u);
  EXPECT_EQ(post("/api/v1/version").status, 405u);
}

TEST_F(Api, AFilmOfWhichNothingIsRenderedIsAConflict) {
  const std::string id = submit();
  EXPECT_EQ(get("/api/v1/jobs/" + id + "/film").status, 409u);
}

TEST_F(Api, BadScenesAndSettingsAre422AndLeaveNoJob) {
  json body = to_json(small_job());
  body["settings"]["spp"] = 0;
  EXPECT_EQ(post("/api/v1/jobs", body).status, 422u);
  body = to_json(small_job());
  body["scene"] = "aGVsbG8=";
  EXPECT_EQ(post("/api/v1/jobs", body).status, 422u);
  EXPECT_TRUE(get_json("/api/v1/jobs")["jobs"].empty());
}

TEST_F(Api, AKeyIsForOneSceneWithOneSettingUntilItsJobHasFailed) {
  JobSpec spec = small_job();
  spec.key = "homework";
  const std::string id = submit(spec);
  EXPECT_EQ(submit(spec), id);
  JobSpec other = spec;
  other.settings.seed = 7;
  const ApiResponse refused = post("/api/v1/jobs", to_json(other));
  EXPECT_EQ(refused.status, 409u);
  EXPECT_NE(refused.body.text().find("homework belongs to job " + id), std::string::npos)
      << refused.body.text();
  post("/api/v1/jobs/" + id + "/cancel");
  EXPECT_NE(submit(other), id);
}

TEST_F(Api, ErrorsAreJsonWithAMessage) { EXPECT_NE(get_json("/api/v1/jobs/7")["error"], ""); }

TEST(FarmDoor, AnAskerIsNotKeptWhenTheFarmHasStopped) {
  FarmDoor dropped([](const auto&) {});
  EXPECT_THROW(dropped.ask([](Farm&, FarmTime) { return 0; }), FarmUnavailable);
  std::vector<std::function<void(Farm&, FarmTime)>> kept;
  FarmDoor stuck([&](auto task) { kept.push_back(std::move(task)); });
  stuck.close();
  EXPECT_THROW(stuck.ask([](Farm&, FarmTime) { return 0; }), FarmUnavailable);
}

TEST(FarmDoor, WhatItsAskerGaveUpIsNotDoneLater) {
  std::vector<std::function<void(Farm&, FarmTime)>> kept;
  FarmDoor stuck([&](auto task) { kept.push_back(std::move(task)); });
  stuck.close();
  EXPECT_THROW(stuck.ask([](Farm& f, FarmTime now) { return f.submit(small_job(), now); }), FarmUnavailable);
  Farm farm;
  kept.at(0)(farm, FarmTime{});
  EXPECT_TRUE(farm.jobs(FarmTime{}).empty());
}

TEST(NewsWait, IsAskedForByJobsAloneAndIsBounded) {
  const auto wait = [](const char* target) { return news_wait({"GET", target, "", "", "", "", ""}); };
  EXPECT_EQ(wait("/api/v1/jobs?after=3&wait=10")->after, 3u);
  EXPECT_EQ(wait("/api/v1/jobs/7?after=3&wait=1000000")->longest, std::chrono::seconds(30));
  EXPECT_FALSE(wait("/api/v1/jobs/7?after=3"));
  EXPECT_FALSE(wait("/api/v1/jobs/7/film?after=3&wait=10"));
  EXPECT_FALSE(wait("/api/v1/workers?after=3&wait=10"));
  EXPECT_FALSE(wait("/%?wait=1"));
}

}  // namespace
}  // namespace rayfarm
