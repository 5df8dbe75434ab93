#include "common/net/stranger_log.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

const StrangerLog::Time start = std::chrono::steady_clock::now();

TEST(StrangerLog, TellsARefusalOnceHoweverOftenItComes) {
  StrangerLog log;
  EXPECT_EQ(log.line_for("a", start), "a");
  EXPECT_EQ(log.line_for("a", start + 90s), std::nullopt);
  EXPECT_EQ(log.line_for("b", start + 90s), "b (and 1 more before it)");
  EXPECT_EQ(log.line_for("a", start + 90s), "a");
}

TEST(StrangerLog, TellsTenInAMinuteAndOfTheOthersTheNumber) {
  StrangerLog log;
  int told = 0;
  for (int i = 0; i < 1000; ++i)
    if (log.line_for(i % 2 == 0 ? "a" : "b", start)) ++told;
  EXPECT_EQ(told, 10);
  EXPECT_EQ(log.line_for("c", start + 59s), std::nullopt);
  EXPECT_EQ(log.line_for("c", start + 60s), "c (and 991 more before it)");
  EXPECT_EQ(log.line_for("d", start + 60s), "d");
}

}  // namespace
}  // namespace rayfarm
