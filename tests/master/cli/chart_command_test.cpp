// rayfarm chart: the samplers of a scene, the failures of the stability suite.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/child_program.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

using Words = std::vector<std::string>;

const std::string scene = RAYFARM_SOURCE_DIR "/scenes/sphere_plane.lua";
const std::string header =
    "case,title,driver_name,method,number,driver,rays,failures,rate,upper_95,allowed\n";

class Charts : public testing::Test {
 protected:
  ProgramResult chart(Words words) const {
    words.insert(words.begin(), {"rayfarm", "chart"});
    return run_program(std::move(words));
  }
  ProgramResult chart_of_table(const std::string& csv, const Words& more = {}) const {
    put_content(folder / "table.csv", csv);
    Words words{"--stability", folder / "table.csv", "-o", folder / "charts"};
    words.insert(words.end(), more.begin(), more.end());
    return chart(words);
  }
  std::string content(const std::string& file) const { return content_of(folder / file); }

  ScratchFolder folder;
};

TEST_F(Charts, OfASceneHaveEachSamplerAtEachNumberOfSamples) {
  const ProgramResult result =
      chart({scene, "-o", folder / "charts", "--size", "16x12", "--most-spp", "16", "--threads", "1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, (folder / "charts/sphere_plane_samplers.csv").string() + "\n" +
                            (folder / "charts/sphere_plane_samplers.svg").string() + "\n");
  const std::string csv = content("charts/sphere_plane_samplers.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 5 * 3);
  const std::string svg = content("charts/sphere_plane_samplers.svg");
  for (const std::string sampler : {"sobol", "jitter", "regular", "random", "adapt1"}) {
    for (const std::string spp : {"1", "4", "16"})
      EXPECT_NE(csv.find("\n" + sampler + "," + spp + ","), std::string::npos) << sampler << spp << csv;
    EXPECT_NE(svg.find(sampler), std::string::npos);
  }
}

TEST_F(Charts, OfTheStabilitySuiteHaveAPanelEachCase) {
  const std::string csv = header + "S1 a,first,distance,ours,double,10,1000,0,0,0.003,0\n" +
                          "S1 a,first,distance,naive,float,10,1000,70,0.07,,\n" +
                          "S2 b,second,distance,ours,double,10,1000,0,0,0.003,0\n";
  ASSERT_EQ(chart_of_table(csv).exit_code, 0);
  const std::string both = content("charts/stability.svg");
  EXPECT_NE(both.find("S1 a: first"), std::string::npos);
  EXPECT_NE(both.find("S2 b: second"), std::string::npos);
  ASSERT_EQ(chart_of_table(csv, {"--cases", "S2"}).exit_code, 0);
  EXPECT_EQ(content("charts/stability.svg").find("S1 a: first"), std::string::npos);
}

TEST_F(Charts, ThatCannotBeDrawnAreRefusedWithTheReason) {
  const auto refused = [&](const ProgramResult& result, const std::string& message) {
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "charts")) << message;
  };
  const std::string charts = folder / "charts", row = "S1,t,d,ours,double,10,1000,0,0,,0\n";
  refused(chart({"-o", charts}), "SCENE or --stability");
  refused(chart({scene, "--stability", "x.csv", "-o", charts}), "not both");
  refused(chart({scene}), "--output");
  refused(chart({scene, "-o", charts, "--most-spp", "0"}), "--most-spp");
  refused(chart({scene, "-o", charts, "-p", "depth=3"}), "depth");
  refused(chart({folder / "none.lua", "-o", charts}), "none.lua");
  refused(chart({"--stability", folder / "none.csv", "-o", charts}), "none.csv");
  refused(chart_of_table("x,y\n1,2\n"), "table.csv: this is not the table of the stability suite");
  refused(chart_of_table(header + row + "S1,t,d,ours,double,ten,1000,0,0,,0\n"),
          "table.csv: line 3: a number");
  refused(chart_of_table(header + row + "S1,t\n"), "table.csv: line 3 has 2 fields");
  refused(chart_of_table(header), "table.csv has no row to chart");
  refused(chart_of_table(header + row, {"--cases", "S2"}), "table.csv has no row to chart");
}

TEST_F(Charts, AreNotWrittenWhereAFileIs) {
  put_content(folder / "charts", "a file");
  const ProgramResult result = chart({scene, "-o", folder / "charts", "--size", "8x6", "--most-spp", "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("charts"), std::string::npos) << result.err;
  EXPECT_EQ(content("charts"), "a file");
}

}  // namespace
}  // namespace rayfarm
