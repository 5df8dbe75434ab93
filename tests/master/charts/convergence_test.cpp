#include "master/charts/convergence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rayfarm {
namespace {

TEST(Convergence, TheSlopeOfAPowerLawIsItsExponent) {
  std::vector<ConvergencePoint> points;
  for (std::uint32_t spp = 1; spp <= 256; spp *= 4)
    points.push_back({"sobol", spp, 0.01 * spp, 3 * std::pow(spp, -0.75)});
  EXPECT_NEAR(fitted_slope(points), -0.75, 1e-12);
  EXPECT_EQ(fitted_slope({points[0]}), 0);
}

TEST(Convergence, ASamplerIsALineWithItsSlope) {
  const Chart chart = convergence_chart(
      "t", {{"sobol", 1, 1, 1}, {"random", 1, 1, 1}, {"sobol", 4, 4, 0.25}, {"random", 4, 4, 0.5}});
  ASSERT_EQ(chart.lines.size(), 2u);
  EXPECT_EQ(chart.lines[0].name, "sobol, slope -1.00");
  EXPECT_EQ(chart.lines[1].name, "random, slope -0.50");
  EXPECT_EQ(chart.lines[1].points.size(), 2u);
}

}  // namespace
}  // namespace rayfarm
