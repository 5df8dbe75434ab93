#include "master/http/api.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "common/net/address.h"
#include "common/net/codec.h"
#include "master/files/film_picture.h"
#include "master/http/submission.h"
#include "tests/master/http/api_fixture.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

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

TEST_F(Api, AJobCanHaveTheSceneOfAnotherWithSettingsOfItsOwn) {
  JobSpec spec = small_job();
  spec.parameters = {{"depth", "3"}};
  const std::string id = submit(spec);
  const json like = {{"scene_of", std::stoull(id)}, {"settings", {{"width", 20u}, {"height", 10u}}}};
  const json job = json::parse(post("/api/v1/jobs", like).body);
  EXPECT_EQ(job["scene_hash"], spec.scene_hash);
  EXPECT_EQ(job["name"], spec.name);
  EXPECT_EQ(job["parameters"], json({{"depth", "3"}}));
  EXPECT_EQ(job["settings"]["width"], 20);
  EXPECT_EQ(job["settings"]["spp"], RenderSettings{}.spp);
}

TEST_F(Api, ASceneThatIsNotThereIsNoJobs) {
  EXPECT_EQ(post("/api/v1/jobs", {{"scene_of", 7u}}).status, 404u);
  EXPECT_EQ(post("/api/v1/jobs", {{"scene_of", "7"}}).status, 400u);
  const std::string id = submit();
  EXPECT_EQ(post("/api/v1/jobs", {{"scene_of", std::stoull(id)}, {"script", ""}}).status, 400u);
  post("/api/v1/jobs/" + id + "/cancel");
  EXPECT_EQ(post("/api/v1/jobs", {{"scene_of", std::stoull(id)}}).status, 409u);
  EXPECT_EQ(get_json("/api/v1/jobs")["jobs"].size(), 1u);
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

TEST_F(Api, AJobIsRemovedOnceItHasEndedAndThenItIsSaidThatItIsNoLongerKept) {
  const std::string id = submit(), job = "/api/v1/jobs/" + id;
  const ApiResponse early = post(job + "/remove");
  EXPECT_EQ(early.status, 409u);
  EXPECT_EQ(json::parse(early.body)["error"], "job " + id + " is waiting: cancel it first");
  farm.add_renderer("pc");
  wait_until_done(id);
  EXPECT_EQ(json::parse(post(job + "/remove").body)["state"], "done");
  EXPECT_TRUE(get_json("/api/v1/jobs")["jobs"].empty());
  for (const char* what : {"", "/frames", "/film", "/picture.png", "/maps/depth", "/statistics"}) {
    const ApiResponse gone = get(job + what);
    EXPECT_EQ(gone.status, 410u) << what;
    EXPECT_EQ(json::parse(gone.body)["error"], "job " + id + " is no longer kept; submit it again") << what;
  }
  EXPECT_EQ(post(job + "/remove").status, 410u);
  EXPECT_EQ(post("/api/v1/jobs", {{"scene_of", 1u}}).status, 410u);
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

TEST_F(Api, AWorkerIsBannedAndListedSoUntilItIsUnbanned) {
  farm.add_idler("pc7");
  EXPECT_EQ(post("/api/v1/workers/pc7/ban").status, 200u);
  const json workers = get_json("/api/v1/workers")["workers"];
  ASSERT_EQ(workers.size(), 1u);
  EXPECT_EQ(workers[0]["name"], "pc7");
  EXPECT_EQ(workers[0]["state"], "banned");
  EXPECT_EQ(post("/api/v1/workers/pc7/unban").status, 200u);
  EXPECT_NE(get_json("/api/v1/workers")["workers"][0]["state"], "banned");
  EXPECT_EQ(post("/api/v1/workers/nobody/ban").status, 404u);
  EXPECT_EQ(post("/api/v1/workers/nobody/unban").status, 404u);
}

TEST_F(Api, AWorkerIsDialledOrABadAddressNamed) {
  std::vector<std::string> dialled;
  master.dial = [&](const std::string& target) {
    if (target.find('=') == std::string::npos) throw AddressError("\"" + target + "\" is no worker to dial");
    dialled.push_back(target);
  };
  master.dialling = [] { return std::vector<Dialling>{{"lab1", "192.168.1.11:5411", "no route to host"}}; };
  EXPECT_EQ(post("/api/v1/workers", {{"dial", "lab1=192.168.1.11"}}).status, 201u);
  EXPECT_EQ(dialled, std::vector<std::string>{"lab1=192.168.1.11"});
  const json worker = get_json("/api/v1/workers")["workers"].at(0);
  EXPECT_EQ(worker["state"], "dialling");
  EXPECT_EQ(worker["address"], "192.168.1.11:5411");
  EXPECT_EQ(worker["message"], "no route to host");
  const ApiResponse bad = post("/api/v1/workers", {{"dial", "lab1"}});
  EXPECT_EQ(bad.status, 422u);
  EXPECT_EQ(json::parse(bad.body)["error"], "\"lab1\" is no worker to dial");
  EXPECT_EQ(post("/api/v1/workers", {{"dail", "lab1=a"}}).status, 400u);
  EXPECT_EQ(post("/api/v1/workers", {{"dial", "lab1=a\nb"}}).status, 422u);
}

TEST_F(Api, ANameIsDialledOnceAndNoLongerOnDemand) {
  std::set<std::string> dialled;
  master.dial = [&](const std::string& target) {
    if (!dialled.insert(target.substr(0, target.find('='))).second) throw NameInUse("it is dialled already");
  };
  master.stop_dialling = [&](const std::string& name) { return dialled.erase(name) != 0; };
  EXPECT_EQ(post("/api/v1/workers", {{"dial", "lab1=192.168.1.11"}}).status, 201u);
  const ApiResponse twice = post("/api/v1/workers", {{"dial", "lab1=192.168.1.12"}});
  EXPECT_EQ(twice.status, 409u);
  EXPECT_EQ(json::parse(twice.body)["error"], "it is dialled already");
  EXPECT_EQ(remove("/api/v1/workers/dial/lab1").status, 200u);
  const ApiResponse again = remove("/api/v1/workers/dial/lab1");
  EXPECT_EQ(again.status, 404u);
  EXPECT_EQ(json::parse(again.body)["error"],
            "no worker \"lab1\" is dialled; GET /api/v1/workers lists those that are");
}

TEST_F(Api, AWorkerThatIsDialledAndCameByItselfIsOneRow) {
  farm.add_idler("lab1");
  master.dialling = [] { return std::vector<Dialling>{{"lab1", "192.168.1.11:5411", "no route to host"}}; };
  const json workers = get_json("/api/v1/workers")["workers"];
  ASSERT_EQ(workers.size(), 1u);
  EXPECT_NE(workers[0]["state"], "dialling");
  EXPECT_EQ(workers[0]["message"], "also dialled, at 192.168.1.11:5411: no route to host");
}

TEST_F(Api, AMisspeltNameInTheQueryIsNamedWithTheKnownOnes) {
  const std::string job = submit();
  const auto error_of = [&](const std::string& target) {
    const ApiResponse refused = get(target);
    EXPECT_EQ(refused.status, 400u) << target;
    return json::parse(refused.body)["error"].get<std::string>();
  };
  EXPECT_EQ(error_of("/api/v1/jobs/" + job + "/trace?x=1&y=1&smaple=3"),
            "\"smaple\" is unknown in the query; known are: format, frame, sample, story, wait, x, y");
  EXPECT_EQ(error_of("/api/v1/version?verbose"),
            "\"verbose\" is unknown in the query; nothing may stand there");
  EXPECT_EQ(error_of("/api/v1/jobs/" + job + "/cloud.ply?points=99999999999"),
            "points must be a whole number from 1 to 2000000, is 99999999999");
  EXPECT_EQ(error_of("/api/v1/jobs/" + job + "/cloud.ply?points=0"),
            "points must be a whole number from 1 to 2000000, is 0");
  EXPECT_EQ(get("/?job=7").status, get("/").status);  // the page's own
}

TEST_F(Api, TheLogIsToldFromANumberOn) {
  master.log = [](std::uint64_t after) {
    EventLog log;
    for (const char* text : {"a", "b", "c"}) log.add({true, text, "pc7"}, FarmTime{});
    return log.after(after);
  };
  const json log = get_json("/api/v1/log?after=1");
  EXPECT_EQ(log["last"], 3);
  ASSERT_EQ(log["lines"].size(), 2u);
  EXPECT_EQ(log["lines"][0]["text"], "b");
  EXPECT_EQ(log["lines"][0]["worker"], "pc7");
  EXPECT_EQ(get_json("/api/v1/log?after=3")["last"], 3);
}

TEST_F(Api, TwoPicturesAreComparedAndWrittenAsTheCommandDoes) {
  farm.add_renderer("pc1");
  JobSpec other = small_job(), smaller = small_job();
  other.settings.seed = 1;
  smaller.settings.width = 32;
  const std::string a = submit(), b = submit(other), c = submit(smaller);
  for (const std::string& id : {a, b, c}) wait_until_done(id);
  const json same = get_json("/api/v1/jobs/" + a + "/difference/" + a),
             not_same = get_json("/api/v1/jobs/" + a + "/difference/" + b);
  for (const char* metric : {"rmse", "mae", "max", "flip"}) {
    EXPECT_EQ(same[metric], 0.0) << metric;
    EXPECT_GT(not_same[metric], 0.0) << metric;
  }
  EXPECT_EQ(get("/api/v1/jobs/" + a + "/difference/" + b + "/flip.png").content_type, "image/png");
  const ApiResponse sizes_differ = get("/api/v1/jobs/" + a + "/difference/" + c);
  EXPECT_EQ(sizes_differ.status, 409u);
  EXPECT_NE(sizes_differ.body.text().find("96x80 and 32x80"), std::string_view::npos);
  EXPECT_EQ(get("/api/v1/jobs/" + a + "/difference/99").status, 404u);

  const ScratchFolder folder;
  farm.run([&](Farm& f, FarmTime now) {
    const JobView job = *f.job(JobId{std::stoull(a)}, now);
    write_picture(folder / "a.exr", film_picture(*f.film(job.id), job.scene_hash, job.settings));
  });
  EXPECT_EQ(get("/api/v1/jobs/" + a + "/picture.exr").body.text(), content_of(folder / "a.exr"));
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

TEST(FarmDoor, TellsNobodyWhatMayBeUndone) {
  Farm farm;
  std::vector<Told> waiting;
  bool is_kept = false;
  std::jthread thread;
  const FarmDoor door(
      [&](const auto& task) {
        thread = std::jthread([&, task] {
          task(farm, FarmTime{});
          is_kept = true;
          waiting.at(0)(std::nullopt);
        });
      },
      [&](Told told) { waiting.push_back(std::move(told)); });
  door.ask([](Farm& f, FarmTime now) { return f.submit(small_job(), now); });
  EXPECT_TRUE(is_kept);
}

TEST(FarmDoor, SaysWhatWasDoneButNotKept) {
  Farm farm;
  const FarmDoor door([&](const auto& task) { task(farm, FarmTime{}); },
                      [](const Told& told) { told("the disk is full"); });
  EXPECT_THROW(door.ask([](Farm& f, FarmTime now) { return f.submit(small_job(), now); }), NotKept);
  EXPECT_EQ(farm.jobs(FarmTime{}).size(), 1u);
}

TEST(FarmDoor, TellsOfAnOrderWhatKeepsItFromOutlivingThePower) {
  Farm farm;
  const FarmDoor door([&](const auto& task) { task(farm, FarmTime{}); }, [](const Told& told) { told({}); },
                      [] { return std::optional<std::string>("the disk is gone"); });
  const auto submit = [](Farm& f, FarmTime now) { return f.submit(small_job(), now); };
  EXPECT_THROW(door.order(submit), NotKept);
  EXPECT_NO_THROW(door.ask(submit)) << "who only looks does not wait";
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
