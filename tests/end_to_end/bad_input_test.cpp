// Bad input at the command line: a clear message, the exit code of the contract, nothing overwritten.
#include "tests/end_to_end/farm_programs.h"

namespace rayfarm {
namespace {

struct BadInput {
  std::string name;     // of the test
  std::string script;   // the scene
  Words options;        // of the picture
  Words must_be_named;  // in the message
};

void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }

std::string scene_with(const std::string& root) {
  return "local ball = sphere{}\nreturn scene{\n  camera = perspective{ from = {0, 0, -5}, direction = {0, "
         "0, 1}, "
         "angle = 50 },\n  lights = { ambient(1) },\n  root = " +
         root + ",\n}\n";
}

const std::vector<BadInput> bad_inputs{
    {"SyntaxError", "local a = 1\nlocal b = = 2\n", {}, {"scene.lua:2"}},
    {"UnknownSolid", scene_with("spere{}"), {}, {"scene.lua:5", "spere"}},
    {"MisspeltKey", scene_with("sphere{ radios = 2 }"), {}, {"scene.lua:5", "radios"}},
    {"NegativeRadius", scene_with("torus{ R = -1, r = 0.2 }"), {}, {"scene.lua:5", "torus"}},
    {"SingularTransform", scene_with("ball:scale(1, 0, 1)"), {}, {"scene.lua:5", "scale"}},
    {"MemoryBomb", "local s = ('x'):rep((1 << 31) - 1)\n", {}, {"scene.lua", "memory"}},
    {"NoScene", "", {}, {"scene.lua"}},
    {"NoPixels", scene_with("ball"), {"--size", "0x5"}, {"--size"}},
    {"TooManyPixels", scene_with("ball"), {"--size", "1000000x1000000"}, {"1000000"}},
    {"UnknownOption", scene_with("ball"), {"--sise", "10x10"}, {"--sise"}},
    {"UnknownParameter", scene_with("ball"), {"-p", "depth=3"}, {"depth"}},
};

/// The master is reached, so it is not its absence that stops the command.
class BadInputs : public FarmPrograms, public testing::WithParamInterface<BadInput> {
 protected:
  BadInputs() { start_master({"--threads", "0"}); }
};

TEST_P(BadInputs, AreUsageErrorsThatNameThePlaceAndChangeNothing) {
  const auto& [name, script, options, must_be_named] = GetParam();
  put_content(folder / "scene.lua", script);
  put_content(folder / "old.exr", "old");
  const Words picture = Words{folder / "scene.lua", "-o", folder / "old.exr"} + options;
  for (const char* command : {"render", "submit"}) {
    const ProgramResult result = rayfarm(Words{command} + picture);
    EXPECT_EQ(result.exit_code, 2) << command;
    for (const std::string& word : must_be_named)
      EXPECT_NE(result.err.find(word), std::string::npos) << word << " in: " << result.err;
    EXPECT_LT(result.err.size(), 600u) << "a message, not a dump: " << result.err;
    EXPECT_EQ(content_of(folder / "old.exr"), "old") << command;
  }
  EXPECT_TRUE(ask("/api/v1/jobs").at("jobs").empty());
}

INSTANTIATE_TEST_SUITE_P(Each, BadInputs, testing::ValuesIn(bad_inputs),
                         [](const auto& info) { return info.param.name; });

class BadCommands : public FarmPrograms {
 protected:
  const std::string scene = scene_file("sphere_plane");
};

TEST_F(BadCommands, AnOutputThatCannotBeWrittenIsToldBeforeAnythingIsRendered) {
  start_master({"--threads", "0"});
  std::filesystem::create_directory(folder / "a folder.exr");
  for (const std::string& output : {std::string("/proc/none/a.exr"), (folder / "none/a.exr").string(),
                                    (folder / "a folder.exr").string(), (folder / "a.jpg").string()})
    for (const char* command : {"render", "submit"}) {
      const ProgramResult result = rayfarm({command, scene, "-o", output, "--spp", "1048576"});
      EXPECT_EQ(result.exit_code, 2) << output;
      EXPECT_NE(result.err.find(std::filesystem::path(output).parent_path()), std::string::npos)
          << result.err;
    }
}

TEST_F(BadCommands, AScriptThatNeverEndsIsStopped) {
  put_content(folder / "scene.lua", "while true do end\n");
  put_content(folder / "old.exr", "old");
  const ProgramResult result = rayfarm({"render", folder / "scene.lua", "-o", folder / "old.exr"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("scene.lua"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("endless loop"), std::string::npos) << result.err;
  EXPECT_EQ(content_of(folder / "old.exr"), "old");
}

TEST_F(BadCommands, AnUnknownJobIsNamed) {
  start_master({"--threads", "0"});
  for (const char* command : {"job", "watch", "fetch", "pause", "resume", "cancel"}) {
    const ProgramResult result = rayfarm({command, "77"});
    EXPECT_EQ(result.exit_code, 1) << command;
    EXPECT_NE(result.err.find("no job 77"), std::string::npos) << result.err;
  }
}

TEST_F(BadCommands, AMasterThatDoesNotRunIsUnreachable) {
  start_master({"--threads", "0"});
  kill_all();
  put_content(folder / "old.exr", "old");
  for (const Words& words :
       {Words{"jobs"}, Words{"workers"}, Words{"submit", scene, "-o", folder / "old.exr"}}) {
    const ProgramResult result = rayfarm(words);
    EXPECT_EQ(result.exit_code, 3) << words[0];
    EXPECT_NE(result.err.find("rayfarm-master"), std::string::npos) << result.err;
  }
  EXPECT_EQ(content_of(folder / "old.exr"), "old");
}

}  // namespace
}  // namespace rayfarm
