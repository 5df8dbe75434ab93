#include "master/cli/text.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

TEST(Text, CountsAreShort) {
  EXPECT_EQ(short_count(0), "0");
  EXPECT_EQ(short_count(999), "999");
  EXPECT_EQ(short_count(1000), "1.0 k");
  EXPECT_EQ(short_count(999'949), "999.9 k");
  EXPECT_EQ(short_count(999'950), "1.0 M");
  EXPECT_EQ(short_count(4.9e9), "4.9 G");
  EXPECT_EQ(short_count(7e15), "7000.0 T");
}

TEST(Text, DurationsAreClocks) {
  EXPECT_EQ(clock_text(std::chrono::seconds(41)), "00:41");
  EXPECT_EQ(clock_text(std::chrono::seconds(3599)), "59:59");
  EXPECT_EQ(clock_text(std::chrono::seconds(3723)), "1:02:03");
  EXPECT_EQ(clock_text(std::chrono::seconds(-1)), "00:00");
}

TEST(Text, OnlyAllIsAHundredPercent) {
  EXPECT_EQ(percent(0, 0), "0%");
  EXPECT_EQ(percent(999, 1000), "99%");
  EXPECT_EQ(percent(1000, 1000), "100%");
  EXPECT_EQ(percent(499'999'999, 500'000'000), "99%");
}

TEST(Text, ColumnsOfATableBeginTogetherAndLinesEndInNoSpace) {
  EXPECT_EQ(table({{"ID", "NAME", "X"}, {"10", "a", ""}, {"7", "circus", "1"}}),
            "ID  NAME    X\n10  a\n7   circus  1\n");
  EXPECT_EQ(table({}), "");
}

TEST(Text, WhatComesFromElsewhereMovesNoCursor) { EXPECT_EQ(printable("a\x1b[2Jb\n\t\x7f"), "a?[2Jb???"); }

}  // namespace
}  // namespace rayfarm
