// What the API tells of how a job's picture came about equals what is made without a farm.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "master/diagnostics/diagnostics.h"
#include "master/diagnostics/leaf_names.h"
#include "master/diagnostics/map_file.h"
#include "master/diagnostics/map_picture.h"
#include "master/http/api.h"
#include "master/http/live/job_layer.h"
#include "master/http/settings_json.h"
#include "tests/support/random_scene.h"
#include "tests/support/test_server.h"
#include "tests/support/test_submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

const auto never = [] { return false; };
const auto unheard = [](std::uint32_t, std::uint32_t) {};

JobSpec random_job() {
  const SceneData scene = scene_data(random_scene(5));
  JobSpec spec = small_job();
  spec.scene_hash = scene.hash, spec.scene_bytes = scene.bytes;
  return spec;
}

/// Nothing is made in the background until the test says so.
class DiagnosticsApi : public testing::Test {
 protected:
  explicit DiagnosticsApi(FarmLimits limits = {}) : farm(limits) {}

  ApiResponse get(const std::string& target) {
    const Doors doors{.farm = door,
                      .feeder = feeder,
                      .diagnostics = diagnostics,
                      .master = master,
                      .app = app,
                      .scenes = scenes,
                      .assets = assets};
    return answer({"GET", "/api/v1/" + target, "", "", "", "", ""}, doors);
  }
  json get_json(const std::string& target) { return json::parse(get(target).body.text()); }
  void expect_error(const std::string& target, unsigned status, const std::string& words) {
    const ApiResponse response = get(target);
    EXPECT_EQ(response.status, status) << target;
    const std::string error = json::parse(response.body.text()).value("error", "");
    EXPECT_NE(error.find(words), std::string::npos) << error;
  }

  JobId submit(const JobSpec& spec = random_job()) {
    JobId id{};
    farm.run([&](Farm& f, FarmTime now) { id = f.submit(spec, now); });
    return id;
  }
  JobId done_job(const JobSpec& spec = random_job()) {
    const JobId id = submit(spec);
    while (get_json(target_of(id))["state"] != "done") std::this_thread::yield();
    return id;
  }
  static std::string target_of(JobId id, const std::string& what = "") {
    return "jobs/" + std::to_string(static_cast<std::uint64_t>(id)) + what;
  }
  int work() {
    int parts = 0;
    while (diagnostics.work_once()) ++parts;
    return parts;
  }
  ApiResponse made(const std::string& target) {
    EXPECT_EQ(get(target).status, 202u) << target;
    work();
    return get(target);
  }

  FarmThread farm;
  FarmDoor door{door_to(farm)};
  FrameFeeder feeder{door};
  Diagnostics diagnostics{0};
  MasterDoor master = lone_master();
  const AppFiles app;
  const SceneLibrary scenes;
  AssetStore assets;
};

/// As the command makes it.
std::string local_csv(const JobSpec& spec, const MapRequest& request) {
  const World world(decode_scene(*spec.scene_bytes));
  const auto map = map_of(world, spec.settings, request, 1, never, unheard);
  return csv(*map, title_of(MapOrigin{request, spec.scene_hash, spec.settings}));
}

TEST_F(DiagnosticsApi, TheMapsAreTheOnesInTheTable) {
  const json maps = get_json("maps")["maps"];
  ASSERT_EQ(maps.size(), all_maps().size());
  for (std::size_t i = 0; i < maps.size(); ++i) {
    EXPECT_EQ(maps[i]["name"], all_maps()[i].name);
    EXPECT_EQ(maps[i]["channels"], all_maps()[i].channels.size());
  }
}

TEST_F(DiagnosticsApi, AMapIsTheLocalOneBeforeWhileAndAfterTheJobIsRendered) {
  const JobId job = submit();
  EXPECT_EQ(made(target_of(job, "/maps/depth?format=csv")).body.text(), local_csv(random_job(), {}));
  farm.add_renderer("pc", 1);
  EXPECT_EQ(made(target_of(job, "/maps/all-rays?format=csv&compat=1")).body.text(),
            local_csv(random_job(), {map_named("all-rays"), {}, true}));
  farm.add_renderer("pc2");
  farm.run([](Farm& f, FarmTime now) { f.drain("pc", now); });
  while (get_json(target_of(job))["state"] != "done") std::this_thread::yield();
  EXPECT_EQ(made(target_of(job, "/maps/normal?format=csv&reduce=closest")).body.text(),
            local_csv(random_job(), {map_named("normal"), Reduction::closest}));
}

TEST_F(DiagnosticsApi, AMapIsAPictureWithFactsAndASharedRange) {
  const JobId job = submit();
  const ApiResponse png = made(target_of(job, "/maps/depth"));
  EXPECT_EQ(png.content_type, "image/png");
  const ApiResponse ranged = get(target_of(job, "/maps/depth?low=1&high=2&scale=perceptual"));
  EXPECT_EQ(ranged.status, 200u);
  EXPECT_NE(ranged.body.text(), png.body.text());
  const ApiResponse exr = get(target_of(job, "/maps/depth?format=exr"));
  EXPECT_EQ(exr.content_type, "image/x-exr");
  EXPECT_NE(exr.body.text().find("rayfarm:scene_hash"), std::string::npos);
}

TEST_F(DiagnosticsApi, AMapBeingMadeSaysHowFarItIs) {
  const JobId job = submit();
  EXPECT_EQ(get_json(target_of(job, "/maps/depth")), json({{"state", "making"}, {"progress", 0.0}}));
  for (int part = 0; part < 4; ++part) diagnostics.work_once();
  EXPECT_EQ(get_json(target_of(job, "/maps/depth"))["progress"], 0.25);
}

TEST_F(DiagnosticsApi, WhatIsThereOfAMapIsGivenToWhoWantsIt) {
  const JobId job = submit();
  const std::string map = target_of(job, "/maps/depth?format=csv");
  const std::string nothing{get(map + "&partial=1").body.text()};
  EXPECT_NE(nothing.find("inf;inf;inf"), std::string::npos);
  while (get_json(map)["progress"] < 0.25) diagnostics.work_once();
  const std::string coarse{get(map + "&partial=1").body.text()};
  EXPECT_NE(coarse, nothing);
  work();
  const std::string whole{get(map).body.text()};
  EXPECT_NE(coarse, whole);
  EXPECT_EQ(get(map + "&partial=1").body.text(), whole);
}

TEST_F(DiagnosticsApi, WhoRenderedWhatIsKnownWhenTheJobIsDone) {
  const JobId job = submit();
  EXPECT_EQ(get(target_of(job, "/maps/worker")).status, 202u);
  EXPECT_EQ(get(target_of(job, "/maps/cost")).status, 202u);
  farm.add_renderer("pc");
  while (get_json(target_of(job))["state"] != "done") std::this_thread::yield();
  const ApiResponse map = get(target_of(job, "/maps/worker?format=csv"));
  EXPECT_NE(map.body.text().find("0: pc"), std::string::npos) << "the labels";
  for (const char c : map.body.text().substr(map.body.text().find('\n')))
    EXPECT_TRUE(c == '0' || c == ';' || c == '\n');
  EXPECT_EQ(get(target_of(job, "/maps/cost?format=csv")).status, 200u);
  EXPECT_EQ(work(), 0) << "the farm knows";
}

TEST_F(DiagnosticsApi, WhatCannotBeAskedIsNamed) {
  const JobId job = submit();
  expect_error(target_of(job, "/maps/height"), 404, "depth, normal");
  expect_error(target_of(job, "/maps/depth?reduce=sum"), 400, "majority");
  expect_error(target_of(job, "/maps/depth?compat=2"), 400, "0 or 1");
  expect_error(target_of(job, "/maps/depth?format=gif"), 400, "png");
  expect_error(target_of(job, "/maps/depth?scale=loud"), 400, "perceptual");
  expect_error(target_of(job, "/maps/depth?low=1"), 400, "together");
  expect_error(target_of(job, "/maps/depth?low=2&high=1"), 400, "less");
  expect_error(target_of(job, "/maps/depth?low=a&high=1"), 400, "number");
  for (const char* what : {"/maps/depth", "/maps/worker", "/statistics", "/scene"})
    expect_error(target_of(JobId{77}, what), 404, "job 77");
  EXPECT_EQ(work(), 0);
}

TEST_F(DiagnosticsApi, ACancelledJobHasNoneButItsCounts) {
  const JobId job = submit();
  farm.run([&](Farm& f, FarmTime now) { f.cancel(job, now); });
  for (const char* what : {"/maps/depth", "/maps/worker", "/scene"})
    expect_error(target_of(job, what), 409, "was cancelled");
  const json detail = get_json(target_of(job, "/statistics"))["detail"];
  EXPECT_EQ(detail["state"], "unavailable");
  EXPECT_NE(detail["message"].get<std::string>().find("was cancelled"), std::string::npos);
}

struct ForgetfulFarm : DiagnosticsApi {
  ForgetfulFarm() : DiagnosticsApi({.film_bytes = 0}) {}
};

TEST_F(ForgetfulFarm, AJobWhoseSceneIsNoLongerKeptSaysSo) {
  farm.add_renderer("pc");
  const JobId first = done_job(), second = done_job();
  for (const char* what : {"/maps/depth", "/maps/cost", "/scene"})
    expect_error(target_of(first, what), 410, "no longer kept");
  EXPECT_EQ(get(target_of(second, "/scene")).status, 200u);
}

TEST_F(DiagnosticsApi, StatisticsAreTheLocalOnes) {
  const JobSpec spec = random_job();
  const World world(decode_scene(*spec.scene_bytes));
  const auto local = statistics_of(world, spec.settings, 1, never, unheard);
  farm.add_renderer("pc");
  const JobId job = done_job(spec);
  const json begun = get_json(target_of(job, "/statistics"));
  EXPECT_EQ(begun["detail"]["state"], "making");
  const json statistics = json::parse(made(target_of(job, "/statistics")).body.text());
  const json counted = to_json(local->rays);
  for (const auto& [name, total] : counted.items()) {
    EXPECT_EQ(begun["counters"][name], total) << "known at once: " << name;
    EXPECT_EQ(statistics["detail"]["counters"][name], total) << name;
  }
  EXPECT_EQ(statistics["counters"]["misses"], local->rays.misses());
  EXPECT_EQ(statistics["samples_per_pixel"], spec.settings.spp);
  EXPECT_EQ(statistics["mean_per_pixel"]["primary"], spec.settings.spp);
  for (const char* phase : {"waiting", "rendering", "threads"}) EXPECT_GE(statistics["seconds"][phase], 0);
  std::map<std::string, std::uint64_t> hits;
  for (const json& leaf : statistics["detail"]["hits"]) hits[leaf["name"]] = leaf["hits"];
  const std::vector<std::string> names = leaf_names(world.scene());
  for (std::size_t leaf = 0; leaf < names.size(); ++leaf) EXPECT_EQ(hits[names[leaf]], local->hits[leaf]);
}

TEST_F(DiagnosticsApi, AJobNobodyHasBegunHasStatisticsToo) {
  const json statistics = get_json(target_of(submit(), "/statistics"));
  EXPECT_EQ(statistics["counters"]["primary"], 0);
  EXPECT_EQ(statistics["samples_per_pixel"], 0);
}

TEST_F(DiagnosticsApi, TheSceneIsTheOneThatWasSubmitted) {
  const json scene = get_json(target_of(submit(), "/scene"));
  EXPECT_EQ(scene["solids"].size(), leaf_names(random_scene(5)).size());
}

TEST_F(DiagnosticsApi, TheRaysOfAPixelAreTheLocalOnes) {
  const JobSpec spec = random_job();
  const World world(decode_scene(*spec.scene_bytes));
  const auto names = std::make_shared<std::vector<std::string>>(leaf_names(world.scene()));
  const JobId job = submit(spec);
  for (const char* sample : {"0", "3", "all", "centre"}) {
    const PixelTrace local =
        pixel_trace(world, names, spec.settings, {40, 41}, sample_choice(sample, spec.settings));
    const std::string target = target_of(job, std::string("/trace?x=40&y=41&sample=") + sample);
    EXPECT_EQ(get_json(target), json::parse(to_json(local).dump()));
    EXPECT_EQ(get(target + "&format=svg").body.text(), svg_of(local));
    EXPECT_EQ(get(target + "&format=text").body.text(), text_of(local));
  }
  EXPECT_EQ(get_json(target_of(job, "/trace?x=40&y=41")),
            get_json(target_of(job, "/trace?x=40&y=41&sample=0")));
}

TEST_F(DiagnosticsApi, APixelThatIsNotThereIsNamed) {
  const JobId job = submit();
  expect_error(target_of(job, "/trace?x=96&y=0"), 400, "95,79");
  expect_error(target_of(job, "/trace?x=1"), 400, "y is missing");
  expect_error(target_of(job, "/trace?x=1&y=-1"), 400, "whole number");
  expect_error(target_of(job, "/trace?x=1&y=1&sample=4"), 400, "from 0 to 3");
  expect_error(target_of(job, "/trace?x=1&y=1&format=png"), 400, "svg");
  farm.run([&](Farm& f, FarmTime now) { f.cancel(job, now); });
  expect_error(target_of(job, "/trace?x=1&y=1"), 409, "was cancelled");
}

TEST_F(DiagnosticsApi, ASampleOfVeryManyRaysIsCut) {
  Scene scene = random_scene(5);
  for (Material& material : scene.materials) material.transmission = material.specular = 1;
  const SceneData data = scene_data(scene);
  JobSpec spec = random_job();
  spec.scene_hash = data.hash, spec.scene_bytes = data.bytes;
  spec.settings.max_depth = 100, spec.settings.min_importance = 0;
  const JobId job = submit(spec);
  bool cut = false;
  for (int x = 0; x < 96 && !cut; x += 5)
    cut = get_json(target_of(job, "/trace?sample=all&y=40&x=" + std::to_string(x)))["truncated"];
  EXPECT_TRUE(cut);
}

TEST_F(DiagnosticsApi, AMapIsALayerForThoseWhoWatchIt) {
  const JobId job = submit();
  const LayerSource layer = map_layer(door, diagnostics, job, {}, {});
  EXPECT_EQ(layer({}, 0).state.state, LayerProgress::making);
  work();
  const LayerNews news = layer({}, 9);
  EXPECT_EQ(news.state.state, LayerProgress::done);
  EXPECT_EQ(news.state.size, (Size{96, 80}));
  EXPECT_EQ(news.tiles.size(), 4u);
  farm.run([&](Farm& f, FarmTime now) { f.cancel(job, now); });
  EXPECT_THROW(layer({}, 9), ApiError);
}

TEST_F(DiagnosticsApi, WhoRenderedWhatIsALayerThatGrowsWithTheJob) {
  const JobId job = submit();
  const LayerSource layer = map_layer(door, diagnostics, job, {}, {map_named("worker")});
  EXPECT_EQ(layer({}, 9).state.state, LayerProgress::making);
  EXPECT_TRUE(layer({}, 9).tiles.empty());
  farm.add_renderer("pc");
  while (layer({}, 0).state.state != LayerProgress::done) std::this_thread::yield();
  EXPECT_EQ(layer({}, 9).tiles.size(), 4u);
  EXPECT_EQ(layer({}, 9).state.labels, std::vector<std::string>{"pc"});
  EXPECT_THROW(map_layer(door, diagnostics, JobId{77}, {}, {map_named("worker")})({}, 0), ApiError);
}

}  // namespace
}  // namespace rayfarm
