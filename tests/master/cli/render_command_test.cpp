#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "master/files/image_file.h"
#include "tests/support/child_program.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

using Words = std::vector<std::string>;

const std::string scene = RAYFARM_SOURCE_DIR "/scenes/sphere_plane.lua";

ProgramResult render(const std::string& script, const std::string& output, const Words& options = {}) {
  Words words{"rayfarm", "render", script, "-o", output};
  words.insert(words.end(), options.begin(), options.end());
  for (const Words& small : {Words{"--size", "64x48"}, Words{"--spp", "4"}})
    if (std::find(options.begin(), options.end(), small[0]) == options.end())
      words.insert(words.end(), small.begin(), small.end());
  return run_program(words);
}

TEST(Render, WritesTheSameFileForAnyNumberOfThreads) {
  const ScratchFolder folder;
  const ProgramResult one = render(scene, folder / "one.exr", {"--threads", "1"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_NE(one.out.find("64x48"), std::string::npos);
  EXPECT_NE(one.out.find("bad samples: 0, lost rays: 0"), std::string::npos);
  EXPECT_EQ(render(scene, folder / "two.exr", {"--threads", "2"}).exit_code, 0);
  EXPECT_EQ(content_of(folder / "one.exr"), content_of(folder / "two.exr"));
}

TEST(Render, PutsSceneAndSettingsIntoTheHeader) {
  const ScratchFolder folder;
  render(scene, folder / "a.exr", {"--seed", "18446744073709551615", "--sampler", "jitter"});
  const auto facts = read_picture(folder / "a.exr").facts;
  EXPECT_EQ(facts.at("rayfarm:seed"), "18446744073709551615");
  EXPECT_EQ(facts.at("rayfarm:sampler"), "jitter");
  EXPECT_EQ(facts.at("rayfarm:scene_hash").size(), 64u);
}

TEST(Render, SummarisesAsJson) {
  const ScratchFolder folder;
  const auto summary = nlohmann::json::parse(render(scene, folder / "a.png", {"--json"}).out);
  EXPECT_EQ(summary["samples"], 64 * 48 * 4);
  EXPECT_EQ(summary["counters"]["primary"], 64 * 48 * 4);
  EXPECT_EQ(summary["settings"]["width"], 64);
}

/// Exit code 2, these words in the message, and an old file as it was.
void expect_refused(const std::string& script_text, const Words& options, const std::string& message) {
  const ScratchFolder folder;
  put_content(folder / "scene.lua", script_text);
  put_content(folder / "a.exr", "old");
  const ProgramResult result = render(folder / "scene.lua", folder / "a.exr", options);
  EXPECT_EQ(result.exit_code, 2) << script_text;
  EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  EXPECT_EQ(content_of(folder / "a.exr"), "old");
  EXPECT_EQ(folder.file_count(), 2u);
}

TEST(Render, BadScenesAndSettingsAreNamedAndOverwriteNothing) {
  const std::string good = content_of(scene);
  expect_refused("local a =\n\nreturn )", {}, "scene.lua:3");
  expect_refused("\nreturn scne{}", {}, "scene.lua:2");
  expect_refused("return 7", {}, "scene.lua");
  expect_refused(good, {"--size", "0x0"}, "--size");
  expect_refused(good, {"--size", "1000000x1000000"}, "--size");
  expect_refused(good, {"--spp", "10", "--sampler", "regular"}, "9 and 16");
  expect_refused(good, {"--sampler", "adapt2"}, "--sampler");
  expect_refused(good, {"-p", "nonsense"}, "key=value");
  expect_refused(good, {"-p", "nonsense=7"}, "nonsense");
}

TEST(Render, AnOutputThatCannotBeWrittenIsToldBeforeTheScriptRuns) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "folder.exr");
  for (const std::string output : {"a.jpg", "missing/a.exr", "folder.exr"}) {
    const ProgramResult result = render(folder / "no_such_script.lua", folder / output);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err.find("script"), std::string::npos) << result.err;
  }
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(Render, AFullDiskLeavesTheOldFile) {
  const ScratchFolder folder;
  put_content(folder / "a.exr", "old");
  const std::string program =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "rayfarm").string();
  const ProgramResult result =
      run_program({"/bin/sh", "-c", "ulimit -f 1; exec \"$0\" \"$@\"", program, "render", scene, "-o",
                   folder / "a.exr", "--size", "64x48", "--spp", "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("a.exr"), std::string::npos) << result.err;
  EXPECT_EQ(content_of(folder / "a.exr"), "old");
  EXPECT_EQ(folder.file_count(), 1u);
}

// The script comes through a pipe: once the program has opened it, it is past its preparations, and the
// interrupt meets it at work, not at start.
TEST(Render, InterruptedItLeavesTheOldFile) {
  const ScratchFolder folder;
  put_content(folder / "a.exr", "old");
  ASSERT_EQ(::mkfifo((folder / "scene.lua").c_str(), 0600), 0);
  ChildProgram program(
      {"rayfarm", "render", folder / "scene.lua", "-o", folder / "a.exr", "--size", "6000x6000"});
  const int pipe = ::open((folder / "scene.lua").c_str(), O_WRONLY | O_CLOEXEC);
  program.send_signal(SIGINT);
  const std::string text = content_of(scene);
  ASSERT_EQ(::write(pipe, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  ::close(pipe);
  const ProgramResult result = program.result();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_NE(result.err.find("nothing was written"), std::string::npos) << result.err;
  EXPECT_EQ(content_of(folder / "a.exr"), "old");
  EXPECT_EQ(folder.file_count(), 2u);
}

}  // namespace
}  // namespace rayfarm
