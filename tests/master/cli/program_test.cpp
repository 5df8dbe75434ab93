// The program as scripts see it: words in, exit code and text out.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "master/files/image_file.h"
#include "tests/support/child_program.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

using Words = std::vector<std::string>;

/// No master answers on port 1.
const std::map<std::string, std::string> no_master{{"RAYFARM_MASTER", "http://127.0.0.1:1"}};

ProgramResult rayfarm(Words words) {
  words.insert(words.begin(), "rayfarm");
  return run_program(std::move(words), no_master);
}

const Words all_commands{"render",  "submit", "jobs",     "job",    "watch",   "fetch", "pause",
                         "resume",  "cancel", "priority", "remove", "workers", "drain", "undrain",
                         "compare", "stats",  "trace",    "map",    "cloud",   "chart"};

TEST(Program, HelpsWithEachCommand) {
  const ProgramResult help = rayfarm({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("Examples:"), std::string::npos);
  for (const std::string& command : all_commands) {
    EXPECT_NE(help.out.find("\n  " + command + " "), std::string::npos) << command;
    EXPECT_EQ(rayfarm({command, "--help"}).exit_code, 0) << command;
  }
  EXPECT_EQ(rayfarm({"--version"}).out, "rayfarm " RAYFARM_VERSION "\n");
}

TEST(Program, WhatItDoesNotKnowIsAUsageError) {
  EXPECT_EQ(rayfarm({}).exit_code, 2);
  EXPECT_EQ(rayfarm({"rendre"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"render"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"jobs", "7"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"job"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"job", "seven"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"job", "-7"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"fetch", "18446744073709551616"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"render", "scene.lua", "-o", "a.exr", "--seed", "-1"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"render", "scene.lua", "-o", "a.exr", "--seed", "18446744073709551616"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"priority", "7", "100"}).exit_code, 2);
  EXPECT_EQ(rayfarm({"compare", "a.exr", "b.exr", "--metric", "psnr"}).exit_code, 2);
  for (const std::string option : {"--error", "--time", "--frames", "--verify"})
    EXPECT_EQ(rayfarm({"submit", "scene.lua", "-o", "a.exr", option, "1"}).exit_code, 2) << option;
}

TEST(Program, NamesTheCommandThatItDoesNotKnowAndTheNearestOne) {
  EXPECT_EQ(rayfarm({"rendre"}).err,
            "rayfarm: there is no command rendre, did you mean 'render'?; rayfarm --help lists them\n");
}

TEST(Program, SaysThatItsOutputWasLost) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "rayfarm";
  const ProgramResult result =
      run_program({"/bin/sh", "-c", "exec \"$0\" \"$@\" >/dev/full", program, "trace",
                   RAYFARM_SOURCE_DIR "/scenes/sphere_plane.lua", "--pixel", "1,1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("cannot write to standard output: No space left on device"), std::string::npos)
      << result.err;
}

TEST(Program, SaysWhereItLookedForAMasterAndHowToStartOne) {
  const ScratchFolder folder;
  const std::string scene = RAYFARM_SOURCE_DIR "/scenes/sphere_plane.lua";
  const std::vector<Words> asking{{"jobs"},           {"job", "1"},
                                  {"watch", "1"},     {"fetch", "1"},
                                  {"pause", "1"},     {"priority", "1", "7"},
                                  {"workers"},        {"drain", "pc1"},
                                  {"jobs", "--json"}, {"submit", scene, "-o", folder / "a.exr"}};
  for (const Words& words : asking) {
    const ProgramResult result = rayfarm(words);
    EXPECT_EQ(result.exit_code, 3) << words[0];
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("http://127.0.0.1:1 "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("rayfarm-master"), std::string::npos);
  }
}

TEST(Program, ARidiculousMasterAddressIsAUsageError) {
  EXPECT_EQ(run_program({"rayfarm", "jobs"}, {{"RAYFARM_MASTER", "ftp://x"}}).exit_code, 2);
}

// Linking OpenImageIO would cost each command a quarter of a second.
TEST(Program, StartsWithoutOpenImageIO) {
  const ProgramResult loaded = run_program({"rayfarm", "jobs"}, {{"LD_TRACE_LOADED_OBJECTS", "1"}});
  EXPECT_NE(loaded.out.find("libc.so"), std::string::npos);
  EXPECT_EQ(loaded.out.find("OpenImageIO"), std::string::npos);
}

TEST(Compare, PrintsTheMetric) {
  const ScratchFolder folder;
  write_picture(folder / "a.exr", {{2, 1}, {0, 0, 0, 1, 1, 1}, {}});
  write_picture(folder / "b.exr", {{2, 1}, {0, 0, 0, 1, 1, 3}, {}});
  EXPECT_EQ(rayfarm({"compare", folder / "a.exr", folder / "b.exr", "--metric", "max"}).out, "max 2\n");
  const auto json = nlohmann::json::parse(
      rayfarm({"compare", folder / "a.exr", folder / "a.exr", "--json", "-o", folder / "diff.png"}).out);
  EXPECT_EQ(json["metric"], "rmse");
  EXPECT_EQ(json["value"], 0);
  EXPECT_EQ(read_picture(folder / "diff.png").rgb, std::vector<float>(6, 0));
}

TEST(Compare, DoesNotOverwriteWhatItCompares) {
  const ScratchFolder folder;
  for (const char* name : {"a.exr", "b.exr"}) write_picture(folder / name, {{2, 1}, {0, 0, 0, 1, 1, 1}, {}});
  for (const std::string output : {"a.exr", "b.exr", "./a.exr"}) {
    const ProgramResult refused =
        rayfarm({"compare", folder / "a.exr", folder / "b.exr", "-o", folder / output});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("would overwrite"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(read_picture(folder / "a.exr").rgb, (std::vector<float>{0, 0, 0, 1, 1, 1}));
}

TEST(Compare, WantsTwoPicturesOfOneSize) {
  const ScratchFolder folder;
  write_picture(folder / "a.exr", {{2, 1}, std::vector<float>(6), {}});
  write_picture(folder / "b.exr", {{1, 2}, std::vector<float>(6), {}});
  const ProgramResult sizes = rayfarm({"compare", folder / "a.exr", folder / "b.exr"});
  EXPECT_EQ(sizes.exit_code, 2);
  EXPECT_NE(sizes.err.find("2x1 and 1x2"), std::string::npos);
  EXPECT_EQ(rayfarm({"compare", folder / "a.exr", folder / "none.exr"}).exit_code, 2);
}

}  // namespace
}  // namespace rayfarm
