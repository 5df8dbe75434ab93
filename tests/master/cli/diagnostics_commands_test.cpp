// The commands that show how a picture came about.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/child_program.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

using Words = std::vector<std::string>;
using nlohmann::json;

const std::string scene = RAYFARM_SOURCE_DIR "/scenes/sphere_plane.lua";

ProgramResult small(const std::string& command, const Words& more = {}) {
  Words words{"rayfarm", command, scene, "--size", "64x48", "--spp", "4"};
  words.insert(words.end(), more.begin(), more.end());
  return run_program(std::move(words));
}

TEST(Stats, CountWhatTheRenderCounts) {
  const ScratchFolder folder;
  const json rendered = json::parse(small("render", {"-o", folder / "a.exr", "--json"}).out);
  const json stats = json::parse(small("stats", {"--json"}).out);
  for (const auto& [name, total] : rendered["counters"].items()) EXPECT_EQ(stats["counters"][name], total);
  EXPECT_EQ(stats["mean_per_pixel"]["primary"], 4);
  std::uint64_t hits = 0;
  for (const json& leaf : stats["hits"]) hits += leaf["hits"].get<std::uint64_t>();
  EXPECT_EQ(hits, stats["counters"]["primary_hits"].get<std::uint64_t>() +
                      stats["counters"]["secondary_hits"].get<std::uint64_t>());
  for (const char* phase : {"script", "build", "render"}) EXPECT_GE(stats["seconds"][phase], 0) << phase;
}

TEST(Stats, ArePrintedAsTables) {
  const ProgramResult result = small("stats");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* word : {"primary", "12288", "misses", "plane #", "PHASE", "64x48"})
    EXPECT_NE(result.out.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace rayfarm
