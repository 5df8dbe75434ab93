#include "master/cli/progress_line.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

TEST(ProgressText, IsABarWithDetailsAndTimeLeft) {
  EXPECT_EQ(progress_text(0.5, "job 3 running", std::chrono::seconds(41), 80),
            "[###############...............] 50%  job 3 running  ETA 00:41");
  EXPECT_EQ(progress_text(1, "", std::nullopt, 16), "[######] 100%  ");
}

TEST(ProgressText, FitsItsTerminalOrLeavesTheBarOut) {
  for (int columns = 0; columns < 120; ++columns) {
    const std::string text = progress_text(0.3, "job 3 running", std::chrono::seconds(41), columns);
    EXPECT_TRUE(static_cast<int>(text.size()) <= columns || text == "30%  job 3 running  ETA 00:41")
        << columns;
  }
}

TEST(ProgressLine, SaysAgainWhatIsSoAgain) {
  ProgressLine line;
  testing::internal::CaptureStderr();
  for (const char* text : {"paused", "paused", "", "paused", "paused: full"}) line.say(text);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "paused\npaused\npaused: full\n");
}

}  // namespace
}  // namespace rayfarm
