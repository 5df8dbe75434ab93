#include "tests/stability/suite.h"

#include <gtest/gtest.h>

#include "master/charts/csv.h"
#include "tests/common/geometry/rays.h"

namespace rayfarm::stability {
namespace {

/// Fails as often as the driver says.
Case coin() {
  const auto fails = [](double driver, RandomRays& random) { return random.uniform(0, 1) < driver; };
  return {"S0",
          "a coin, \"fair\" or not",
          "chance",
          {0, 0.25, 0.5},
          {{"plain", "double", ray_by_ray<RandomRays>(fails), {}},
           {"ours", "float", ray_by_ray<RandomRays>(fails), 0.3}},
          {10'500, 1'050'000, 1'000}};
}

std::vector<StabilityRow> rows_of(const SuiteOptions& options) {
  return run_suite({coin()}, options, [](const StabilityRow&) {});
}

TEST(Suite, ThreadsDoNotShowInTheTable) {
  EXPECT_EQ(stability_csv(rows_of({.threads = 1})), stability_csv(rows_of({.threads = 3})));
}

TEST(Suite, AllMethodsSeeTheSameRays) {
  const auto rows = rows_of({.threads = 2});
  ASSERT_EQ(rows.size(), 6u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rows[i].rays, 10'500u);
    EXPECT_EQ(rows[i].failures, rows[i + 3].failures);
  }
}

TEST(Suite, OursIsJudgedByWhatItIsAllowed) {
  const auto rows = rows_of({.threads = 2});
  EXPECT_TRUE(rows[2].passes()) << "only compared";
  EXPECT_TRUE(rows[4].passes());
  EXPECT_FALSE(rows[5].passes());
}

TEST(Suite, TheLongFormGivesOursAHundredTimesTheRaysOfOthers) {
  const auto rows = rows_of({.is_long = true, .threads = 2});
  EXPECT_EQ(rows[0].rays, 10'500u);
  EXPECT_EQ(rows[3].rays, 1'050'000u);
}

TEST(Suite, ItsTableCanBeReadBack) {
  const auto rows = rows_of({.threads = 1});
  EXPECT_EQ(stability_rows(stability_csv(rows)), rows);
  EXPECT_THROW(stability_rows("x,y\n1,2\n"), CsvError);
}

TEST(Suite, AZeroIsReportedAsABound) {
  const auto rows = rows_of({.threads = 1});
  EXPECT_EQ(rate_text(rows[0]), "<= 0.00029");
}

}  // namespace
}  // namespace rayfarm::stability
