#include "master/files/ply.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rayfarm {
namespace {

TEST(PlyHeader, IsAsLongForAnyNumberOfPoints) {
  for (const PlyForm form : {PlyForm::binary, PlyForm::ascii, PlyForm::compact}) {
    const std::size_t length = ply_header(form, 0).size();
    for (const std::uint64_t points : {1ull, 999ull, 1000ull, 18446744073709551615ull}) {
      const std::string header = ply_header(form, points);
      EXPECT_EQ(header.size(), length);
      EXPECT_NE(header.find("\nelement vertex " + std::to_string(points) + "\n"), std::string::npos);
      EXPECT_TRUE(header.starts_with("ply\nformat "));
      EXPECT_TRUE(header.ends_with("\nend_header\n"));
    }
  }
}

TEST(Octahedral, BringsAUnitVectorBackWithinFourThousandthsOfADegree) {
  std::mt19937 random(3);
  std::normal_distribution<double> component;
  double worst = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double x = component(random), y = component(random), z = component(random);
    const double size = std::sqrt(x * x + y * y + z * z);
    const std::array<float, 3> n{static_cast<float>(x / size), static_cast<float>(y / size),
                                 static_cast<float>(z / size)};
    const std::array<float, 3> back = unit_of(octahedral(n));
    const double dx = back[0] - n[0], dy = back[1] - n[1], dz = back[2] - n[2];
    worst = std::max(worst, std::sqrt(dx * dx + dy * dy + dz * dz));
    ASSERT_NEAR(back[0] * back[0] + back[1] * back[1] + back[2] * back[2], 1, 1e-6);
  }
  EXPECT_LT(worst, 0.004 * 3.14159265358979 / 180);
}

TEST(Octahedral, KeepsTheAxesExactly) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      std::array<float, 3> n{};
      n[static_cast<std::size_t>(axis)] = sign;
      EXPECT_EQ(unit_of(octahedral(n)), n);
    }
}

}  // namespace
}  // namespace rayfarm
