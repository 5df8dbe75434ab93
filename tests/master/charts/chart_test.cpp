#include "master/charts/chart.h"

#include <gtest/gtest.h>

#include <regex>

#include "master/charts/axis_map.h"
#include "master/charts/stability_table.h"

namespace rayfarm {
namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(AxisMap, EqualFactorsAreEquallyFarOnALogarithmicAxis) {
  const AxisMap axis(AxisScale::logarithmic, {1e-6, 1, 1e3});
  EXPECT_NEAR(axis.place(1e-3) - axis.place(1e-6), axis.place(1) - axis.place(1e-3), 1e-12);
  EXPECT_GE(axis.place(1e-6), 0);
  EXPECT_LE(axis.place(1e3), 1);
}

TEST(AxisMap, AZeroStandsBelowEverythingElseOfALogarithmicAxis) {
  const AxisMap axis(AxisScale::logarithmic, {0, 1e-300, 1});
  EXPECT_LT(axis.place(0), axis.place(1e-300));
  EXPECT_GE(axis.place(0), 0);
  EXPECT_EQ(axis.ticks()[0].label, "0");
}

TEST(AxisMap, HasAFewLabelledTicksWithinItsRange) {
  for (const auto& values : {std::vector<double>{1e-12, 1e8}, {0.2, 0.9}, {1, 1024}, {3, 3}, {}})
    for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic}) {
      const AxisMap axis(scale, values);
      std::size_t labelled = 0;
      for (const Tick& tick : axis.ticks()) {
        EXPECT_GE(axis.place(tick.value), -1e-9);
        EXPECT_LE(axis.place(tick.value), 1 + 1e-9);
        labelled += !tick.label.empty();
      }
      EXPECT_GE(labelled, 1u);
      EXPECT_LE(labelled, 14u);
    }
}

TEST(AxisMap, IsLogarithmicWhereValuesReachOverDecades) {
  const double wide[] = {1, 1e4}, narrow[] = {1, 20}, negative[] = {-20, 20, 1e4};
  EXPECT_EQ(scale_for(wide), AxisScale::logarithmic);
  EXPECT_EQ(scale_for(narrow), AxisScale::linear);
  EXPECT_EQ(scale_for(negative), AxisScale::linear);
}

TEST(Chart, ABoundIsAnOpenMark) {
  Chart chart{"a < b", {"x"}, {"y"}, {{"ours", {{1, 0.5, false}, {10, 1e-6, true}}, true}}};
  const std::string svg = svg_of({&chart, 1});
  EXPECT_EQ(count_of(svg, "fill=\"#fff\" stroke=\"#007a5a\""), 1u);
  EXPECT_EQ(count_of(svg, "fill=\"#007a5a\" stroke=\"#007a5a\""), 2u) << "the other one and the legend's";
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
}

TEST(Chart, NoNumberInItIsNotFinite) {
  std::vector<Chart> charts{{"empty", {"x"}, {"y"}, {}},
                            {"one", {"x"}, {"y"}, {{"l", {{1, 1}}}}},
                            {"zeros", {"x"}, {"y"}, {{"l", {{0, 0}, {0, 0}}}}}};
  for (const int columns : {1, 2, 3}) {
    const std::string svg = svg_of(charts, columns);
    EXPECT_FALSE(std::regex_search(svg, std::regex("\"-?(nan|inf)"))) << columns;
  }
}

TEST(StabilityTable, ACaseIsAChartAMethodALine) {
  std::vector<StabilityRow> rows;
  for (const char* name : {"S1", "S2"})
    for (const char* method : {"naive", "ours"})
      for (const double driver : {1e3, 1.0})
        rows.push_back({name, "title", "driver", method, "double", driver, 1000, 0,
                        method == std::string("ours") ? std::optional(0.0) : std::nullopt});
  const std::vector<Chart> charts = stability_charts(rows);
  ASSERT_EQ(charts.size(), 2u);
  ASSERT_EQ(charts[0].lines.size(), 2u);
  EXPECT_FALSE(charts[0].lines[0].is_ours);
  EXPECT_TRUE(charts[0].lines[1].is_ours);
  EXPECT_EQ(charts[0].lines[1].points[0].x, 1);
  EXPECT_EQ(charts[0].lines[1].points[0].y, 3e-3) << "a zero of 1000 rays";
  EXPECT_TRUE(charts[0].lines[1].points[0].is_bound);
}

}  // namespace
}  // namespace rayfarm
