#include "common/math/affine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rayfarm {
namespace {

double distance(const Affine& a, const Affine& b) {
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    most = std::max(most, std::fabs(a.offset[i] - b.offset[i]));
    for (int j = 0; j < 3; ++j) most = std::max(most, std::fabs(a.linear[i][j] - b.linear[i][j]));
  }
  return most;
}

TEST(Affine, AProductDoesTheRightOneFirst) {
  const Affine map = translation({0, 1, 0}) * scaling({2, 2, 2});
  EXPECT_EQ(point(map, {1, 1, 1}), glm::dvec3(2, 3, 2));
}

TEST(Affine, QuarterTurnsAreExactAndGoFromOneAxisToTheNext) {
  EXPECT_EQ(point(rotation_deg(0, 90), {0, 1, 0}), glm::dvec3(0, 0, 1));   // x: y to z
  EXPECT_EQ(point(rotation_deg(1, 90), {0, 0, 1}), glm::dvec3(1, 0, 0));   // y: z to x
  EXPECT_EQ(point(rotation_deg(2, 90), {1, 0, 0}), glm::dvec3(0, 1, 0));   // z: x to y
  EXPECT_EQ(point(rotation_deg(0, -90), {0, 0, 1}), glm::dvec3(0, 1, 0));  // a plane's normal to up
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(rotation_deg(axis, 360), Affine{});
    EXPECT_EQ(rotation_deg(axis, 90) * rotation_deg(axis, 270), Affine{});
  }
}

TEST(Affine, AFreeAxisTurnsAsItsCoordinateAxisDoes) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double angle : {-400.0, -90.0, 0.0, 17.0, 30.0, 90.0, 180.0, 333.3}) {
      glm::dvec3 free(0.0);
      free[axis] = 1e-200;  // any length
      EXPECT_LT(distance(rotation_deg(free, angle), rotation_deg(axis, angle)), 1e-15);
    }
}

TEST(Affine, ARotationKeepsItsAxisAndAllLengths) {
  const glm::dvec3 axis(1, -2, 0.5);
  const Affine turn = rotation_deg(axis, 77);
  EXPECT_LT(glm::length(point(turn, axis) - axis), 1e-15);
  EXPECT_NEAR(glm::determinant(turn.linear), 1, 1e-15);
  EXPECT_LT(distance({turn.linear * glm::transpose(turn.linear), glm::dvec3(0.0)}, {}), 1e-15);
}

TEST(Affine, InvertibleIsAQuestionOfShapeNotOfSize) {
  const Affine shape = rotation_deg(glm::dvec3(1, 2, 3), 40) * scaling({1, 1000, 1e-6});
  for (const double size : {1e-60, 1e-9, 1.0, 1e9, 1e60}) {
    EXPECT_TRUE(is_invertible(scaling(glm::dvec3(size)) * shape));
    EXPECT_FALSE(is_invertible(scaling(glm::dvec3(size)) * shape * scaling({1, 0, 1})));
    // Flat, though rounding leaves a determinant that is not 0.
    const Affine flat{glm::dmat3(0.1, 0.2, 0.3, 0.7, 0.1, 0.9, 0.8, 0.3, 1.2), glm::dvec3(0.0)};
    EXPECT_FALSE(is_invertible(scaling(glm::dvec3(size)) * flat));
  }
  EXPECT_TRUE(is_invertible(scaling({-1, 1, 1})));
}

TEST(Affine, WhatIsNotFiniteIsNotInvertible) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_invertible(translation({0, inf, 0})));
  EXPECT_FALSE(is_invertible(translation({0, 0, NAN})));
  EXPECT_FALSE(is_invertible(scaling({1, inf, 1})));
  EXPECT_FALSE(is_invertible(scaling({1, NAN, 1})));
  EXPECT_FALSE(is_invertible(scaling({1e-150, 1e-150, 1e-150})));  // its inverse's determinant is infinite
}

}  // namespace
}  // namespace rayfarm
