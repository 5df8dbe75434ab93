#include "master/files/difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rayfarm {
namespace {

Picture flat(float value, Size size = {24, 20}) {
  return {size, std::vector<float>(std::size_t{3} * size.width * size.height, value), {}};
}

constexpr Metric all_metrics[] = {Metric::rmse, Metric::mae, Metric::max, Metric::flip};

TEST(Difference, IsZeroExactlyBetweenEqualPictures) {
  for (const Metric metric : all_metrics) {
    EXPECT_EQ(difference(flat(0.3f), flat(0.3f), metric).value, 0) << name_of(metric);
    EXPECT_GT(difference(flat(0.3f), flat(0.4f), metric).value, 0) << name_of(metric);
  }
}

TEST(Difference, IsTheSameBothWays) {
  Picture spot = flat(0.2f);
  spot.rgb[700] = 0.9f;
  for (const Metric metric : all_metrics)
    EXPECT_EQ(difference(spot, flat(0.2f), metric).value, difference(flat(0.2f), spot, metric).value);
}

TEST(Difference, OfOneChangedValueIsWhatTheFormulasSay) {
  Picture spot = flat(0, {2, 2});
  spot.rgb[4] = 3;
  EXPECT_DOUBLE_EQ(difference(flat(0, {2, 2}), spot, Metric::max).value, 3);
  EXPECT_DOUBLE_EQ(difference(flat(0, {2, 2}), spot, Metric::mae).value, 3.0 / 12);
  EXPECT_DOUBLE_EQ(difference(flat(0, {2, 2}), spot, Metric::rmse).value, std::sqrt(9.0 / 12));
  EXPECT_EQ(difference(flat(0, {2, 2}), spot, Metric::max).picture.rgb[4], 3);
}

TEST(Difference, OfNotANumberIsInfiniteUnlessBothAre) {
  const float nan = std::nanf("");
  EXPECT_EQ(difference(flat(nan), flat(nan), Metric::max).value, 0);
  EXPECT_TRUE(std::isinf(difference(flat(nan), flat(1), Metric::max).value));
}

TEST(Difference, OfPicturesOfDifferentSizeIsAnError) {
  EXPECT_THROW(difference(flat(0, {2, 3}), flat(0, {3, 2}), Metric::rmse), FileError);
}

// By the paper's formulas a flat black and a flat white picture differ in lightness alone, by 100: that error
// to the power 0.7 lies above the knee, where the last 5 % of the range begin.
TEST(Flip, BetweenBlackAndWhiteIsNearlyOne) {
  EXPECT_NEAR(difference(flat(0), flat(1), Metric::flip).value, 0.9675, 0.001);
}

TEST(Flip, IsLargestWhereThePicturesDifferAndNothingFarAway) {
  Picture line = flat(0.5f, {64, 20});
  for (std::size_t y = 0; y < 20; ++y)
    for (std::size_t c = 0; c < 3; ++c) line.rgb[(y * 64 + 20) * 3 + c] = 0.9f;
  const std::vector<float> error = difference(flat(0.5f, {64, 20}), line, Metric::flip).picture.rgb;
  const auto at = [&](std::size_t x) { return error[(10 * 64 + x) * 3]; };
  EXPECT_GT(at(20), 0.1);
  EXPECT_LE(at(20), 1);
  EXPECT_GT(at(20), at(25));
  EXPECT_EQ(at(50), 0);  // farther than the widest kernel, 10 pixels
}

TEST(Metric, NamesReadBack) {
  for (const Metric metric : all_metrics) EXPECT_EQ(metric_named(name_of(metric)), metric);
  EXPECT_FALSE(metric_named("psnr"));
}

}  // namespace
}  // namespace rayfarm
