#include "master/http/live/half.h"

#include <gtest/gtest.h>

#include "tests/support/layer_view.h"

namespace rayfarm {
namespace {

TEST(Half, EachHalfComesBack) {
  for (std::uint32_t half = 0; half < 65536; ++half) {
    const float number = float_of_half(static_cast<std::uint16_t>(half));
    if (std::isnan(number))
      EXPECT_TRUE(std::isnan(float_of_half(half_of(number))));
    else
      EXPECT_EQ(half_of(number), half);
  }
}

// Between each two neighbours the middle, and what is next to it on both sides.
TEST(Half, WhatLiesBetweenGoesToTheNearestAndTheMiddleToTheEven) {
  for (std::uint16_t low = 0; low < 0x7bff; ++low) {
    const float below = float_of_half(low), above = float_of_half(low + 1), middle = (below + above) / 2;
    EXPECT_EQ(half_of(middle), low % 2 == 0 ? low : low + 1) << middle;
    EXPECT_EQ(half_of(std::nextafter(middle, below)), low) << middle;
    EXPECT_EQ(half_of(std::nextafter(middle, above)), low + 1) << middle;
    EXPECT_EQ(half_of(-middle), half_of(middle) | 0x8000);
  }
}

TEST(Half, WhatIsTooLargeIsInfiniteAndWhatIsNoNumberStaysNone) {
  EXPECT_EQ(half_of(65519.996f), 0x7bff);
  EXPECT_EQ(half_of(65520.0f), 0x7c00);
  EXPECT_EQ(half_of(INFINITY), 0x7c00);
  EXPECT_EQ(half_of(-INFINITY), 0xfc00);
  for (const std::uint32_t bits : {0x7f800001u, 0x7fc00000u, 0xffffffffu, 0x7f802000u})
    EXPECT_TRUE(std::isnan(float_of_half(half_of(std::bit_cast<float>(bits))))) << bits;
}

}  // namespace
}  // namespace rayfarm
