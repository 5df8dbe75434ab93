// The commands that show how a picture came about.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "master/files/image_file.h"
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
  EXPECT_EQ(stats["samples_per_pixel"], 4);
  EXPECT_EQ(stats["counters"]["lost"], 0);
  EXPECT_EQ(stats["tests"]["shadow"]["rays"], stats["counters"]["shadow"]);
  EXPECT_GT(stats["tests"]["nearest"]["leaves_per_ray"], 1);
  for (const char* phase : {"script", "build", "render"}) EXPECT_GE(stats["seconds"][phase], 0) << phase;
}

TEST(Stats, ArePrintedAsTables) {
  const ProgramResult result = small("stats");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* word :
       {"primary", "12288", "misses", "lost rays", "plane #", "SOLIDS TESTED", "PHASE", "64x48"})
    EXPECT_NE(result.out.find(word), std::string::npos) << word;
}

TEST(Stats, OfAnAdaptiveSamplerTellTheSamplesThatWereTaken) {
  const json stats = json::parse(run_program({"rayfarm", "stats", scene, "--size", "64x48", "--spp", "64",
                                              "--sampler", "adapt1", "--json"})
                                     .out);
  const double taken = stats["samples_per_pixel"];
  EXPECT_GT(taken, 4);
  EXPECT_LT(taken, 64);
  EXPECT_EQ(taken * 64 * 48, stats["counters"]["primary"]);
}

TEST(Trace, TheSamplesMeanIsThePixelOfTheRenderedFile) {
  const ScratchFolder folder;
  small("render", {"-o", folder / "a.exr"});
  const std::vector<float> rgb = read_picture(folder / "a.exr").rgb;
  for (const auto& [x, y] : {std::pair{0, 0}, {32, 24}, {20, 40}}) {
    const std::string pixel = std::to_string(x) + "," + std::to_string(y);
    const json trace = json::parse(small("trace", {"--pixel", pixel, "--sample", "all", "--json"}).out);
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (const json& sample : trace["samples"]) sum += sample["color"][c].get<double>();
      EXPECT_EQ(static_cast<float>(sum / 4), rgb[3 * static_cast<std::size_t>(y * 64 + x) + c]) << pixel;
    }
  }
}

TEST(Trace, PrintsATreeAndDrawsIt) {
  const ScratchFolder folder;
  const ProgramResult result = small("trace", {"--pixel", "32,24", "-o", folder / "a.svg"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("ray 0, primary, "), std::string::npos);
  EXPECT_NE(content_of(folder / "a.svg").find("<svg "), std::string::npos);
}

TEST(Trace, WhatIsNotThereIsNamed) {
  const auto refused = [](const Words& more, const std::string& message) {
    const ProgramResult result = small("trace", more);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  };
  refused({"--pixel", "64,0"}, "63,47");
  refused({"--pixel", "7"}, "X,Y");
  refused({"--pixel", "1,-1"}, "X,Y");
  refused({"--pixel", "1,1", "--sample", "4"}, "from 0 to 3");
  refused({"--pixel", "1,1", "--sample", "some"}, "centre");
  refused({"--pixel", "1,1", "-o", "a.png"}, ".svg");
  refused({"--pixel", "1,1", "-o", "no_such_folder/a.svg"}, "no_such_folder");
}

/// The numbers of a CSV file's lines, without its comment.
std::vector<std::vector<std::string>> cells_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ';');) rows.back().push_back(cell);
  }
  return rows;
}

TEST(MapCommand, CsvAndExrHoldTheSameNumbers) {
  const ScratchFolder folder;
  for (const std::string kind : {"depth", "normal", "primary-rays"}) {
    for (const char* file : {"a.csv", "a.exr"}) {
      const ProgramResult result =
          run_program({"rayfarm", "map", kind, scene, "-o", folder / file, "--size", "64x48", "--spp", "4"});
      ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    const std::vector<float> rgb = read_picture(folder / "a.exr").rgb;
    const auto rows = cells_of(folder / "a.csv");
    const std::size_t channels = kind == "normal" ? 3 : 1;
    ASSERT_EQ(rows.size(), 48u);
    for (std::size_t y = 0; y < 48; ++y) {
      ASSERT_EQ(rows[y].size(), 64 * channels);
      for (std::size_t i = 0; i < rows[y].size(); ++i)
        ASSERT_EQ(std::stof(rows[y][i]), rgb[channels == 3 ? y * 192 + i : (y * 64 + i) * 3]);
    }
  }
}

TEST(MapCommand, WritesColorsAndSaysWhatTheyAre) {
  const ScratchFolder folder;
  const ProgramResult result = run_program({"rayfarm", "map", "all-rays", scene, "-o", folder / "a.png",
                                            "--size", "64x48", "--spp", "4", "--compat"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Picture picture = read_picture(folder / "a.png");
  EXPECT_EQ(picture.size, (Size{64, 48}));
  EXPECT_EQ(picture.facts.at("rayfarm:map"), "all-rays compatible");
}

TEST(MapCommand, WhatItDoesNotKnowIsAUsageError) {
  const ScratchFolder folder;
  EXPECT_EQ(run_program({"rayfarm", "map", "height", scene, "-o", folder / "a.png"}).exit_code, 2);
  EXPECT_EQ(run_program({"rayfarm", "map", "depth", scene, "-o", folder / "a.txt"}).exit_code, 2);
  EXPECT_EQ(
      run_program({"rayfarm", "map", "depth", scene, "-o", folder / "a.csv", "--reduce", "sum"}).exit_code,
      2);
  EXPECT_EQ(run_program({"rayfarm", "map", "depth", scene, "-o", (folder / "missing") / "a.csv"}).exit_code,
            2);
  EXPECT_EQ(folder.file_count(), 0u);
}

}  // namespace
}  // namespace rayfarm
