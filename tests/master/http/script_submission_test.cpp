#include "master/http/script_submission.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

using nlohmann::json;

constexpr const char* balls = R"(-- Balls in a row. More of them.
local count = param{ "count", type = "int", default = 2, min = 1, max = 9, help = "how many" }
local row = {}
for i = 1, count do row[i] = sphere{}:translate(3 * i, 0, 0) end
return scene{ camera = perspective{ from = {0, 0, -9}, angle = 60 }, lights = { ambient(1) }, root = union(row),
              image = { width = 320, height = 200 }, animation = { start = 0, stop = 2, fps = 10 } }
)";

class ScriptSubmission : public testing::Test {
 protected:
  ScriptSubmission() { put_content(folder / "balls.lua", balls); }
  JobSpec submitted(const json& body) const { return submitted_job(body, library, store).spec; }
  unsigned status_of(const json& body) const {
    try {
      submitted(body);
    } catch (const ApiError& error) {
      return error.status;
    }
    return 0;
  }

  const ScratchFolder folder;
  const SceneLibrary library{folder.path()};
  mutable AssetStore store;
};

TEST_F(ScriptSubmission, AnOfferedSceneIsEvaluatedWithItsParameters) {
  const JobSpec spec =
      submitted({{"scene_name", "balls"}, {"parameters", {{"count", "5"}}}, {"settings", {{"spp", 4u}}}});
  EXPECT_EQ(spec.name, "balls");
  EXPECT_EQ(spec.parameters.at("count"), "5");
  EXPECT_EQ(spec.settings.width, 320u);  // the scene's
  EXPECT_EQ(spec.settings.spp, 4u);      // the submitter's
  EXPECT_EQ(spec.settings.max_depth, RenderSettings{}.max_depth);
  EXPECT_EQ(decode_scene(*spec.scene_bytes).nodes.size(), 6u);
  EXPECT_EQ(spec.scene_hash, sha256_hex(*spec.scene_bytes));
}

TEST_F(ScriptSubmission, AnEvaluationEndsWhenItsAskerLeaves) {
  const json endless{{"script", "while true do end"}};
  const auto message_of = [](auto evaluation) -> std::string {
    try {
      evaluation();
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  const auto has_left = [] { return true; };
  EXPECT_EQ(message_of([&] { script_facts(endless, has_left); }), "script.lua: interrupted");
  EXPECT_EQ(message_of([&] { submitted_job(endless, library, store, has_left); }), "script.lua: interrupted");
}

TEST_F(ScriptSubmission, AnUploadedScriptIsTheSameScene) {
  const JobSpec offered = submitted({{"scene_name", "balls"}});
  const JobSpec uploaded =
      submitted({{"script", balls}, {"script_name", "mine.lua"}, {"settings", {{"width", 64u}}}});
  EXPECT_EQ(uploaded.name, "mine");
  EXPECT_EQ(uploaded.scene_hash, offered.scene_hash);
  EXPECT_EQ(uploaded.settings.width, 64u);
  EXPECT_EQ(uploaded.settings.height, 200u);
}

TEST_F(ScriptSubmission, WhatIsWrongIsNamed) {
  EXPECT_EQ(status_of({{"scene_name", "absent"}}), 404u);
  EXPECT_EQ(status_of({{"scene_name", "../balls"}}), 404u);
  EXPECT_EQ(status_of(json::object()), 400u);
  EXPECT_EQ(status_of({{"scene_name", "balls"}, {"script", balls}}), 400u);
  EXPECT_EQ(status_of({{"script", balls}, {"parameters", {{"count", 5}}}}), 400u);
  EXPECT_EQ(status_of({{"script", std::string(longest_script + 1, ' ')}}), 413u);
  EXPECT_EQ(status_of({{"script", balls}, {"script_name", "a\nb"}}), 422u);
  EXPECT_THROW(submitted({{"script", balls}, {"parameters", {{"cuont", "5"}}}}), SceneError);
  EXPECT_THROW(submitted({{"script", balls}, {"settings", {{"width", 0}}}}), SettingsError);
  try {
    submitted({{"script", "local x = 1\nreturn spere{}"}, {"script_name", "my.lua"}});
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("my.lua:2: ")) << error.what();
  }
}

TEST_F(ScriptSubmission, AScriptTellsWhatItDeclares) {
  const json facts = to_json(script_facts({{"script", balls}, {"name", "balls.lua"}}));
  const json expected = {{"name", "count"},          {"type", "int"}, {"default", "2"}, {"help", "how many"},
                         {"choices", json::array()}, {"min", 1.0},    {"max", 9.0}};
  EXPECT_EQ(facts["parameters"], json::array({expected}));
  EXPECT_EQ(facts["image"], (json{{"width", 320}, {"height", 200}, {"spp", nullptr}}));
  EXPECT_EQ(facts["animation"], (json{{"start", 0.0}, {"stop", 2.0}, {"fps", 10.0}}));
}

TEST_F(ScriptSubmission, TheLibraryListsBrokenScenesWithTheirErrorAndSeesChanges) {
  put_content(folder / "broken.lua", "-- A broken one.\nreturn nonsense");
  std::vector<OfferedScene> scenes = library.scenes();
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(scenes[0].title, "Balls in a row.");
  EXPECT_EQ(scenes[0].error, "");
  EXPECT_EQ(scenes[1].title, "A broken one.");
  EXPECT_TRUE(scenes[1].error.starts_with("broken.lua:2: ")) << scenes[1].error;
  put_content(folder / "broken.lua", balls);
  std::filesystem::last_write_time(folder / "broken.lua",
                                   std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(library.scenes()[1].error, "");
  EXPECT_TRUE(SceneLibrary(folder / "absent").scenes().empty());
}

TEST(FirstSentence, EndsAtItsFullStopOrWithTheComment) {
  EXPECT_EQ(first_sentence("-- One. Two."), "One.");
  EXPECT_EQ(first_sentence("-- One\n-- and a half.\nreturn 1"), "One and a half.");
  EXPECT_EQ(first_sentence("-- 2.5 balls: all\nreturn 1"), "2.5 balls: all");
  EXPECT_EQ(first_sentence("return 1"), "");
}

}  // namespace
}  // namespace rayfarm
