#include "master/diagnostics/ticks.h"

#include <gtest/gtest.h>

#include <thread>

namespace rayfarm {
namespace {

TEST(Ticks, MeasureWhatTheClockMeasures) {
  using Clock = std::chrono::steady_clock;
  const double rate = seconds_per_tick();
  // The clock is read on both sides of the ticks: whenever the thread is interrupted, they lie between.
  const Clock::time_point before = Clock::now();
  const std::int64_t first = ticks();
  const Clock::time_point after_first = Clock::now();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const Clock::time_point before_last = Clock::now();
  const std::int64_t last = ticks();
  const Clock::time_point after = Clock::now();
  const double seconds = rate * static_cast<double>(last - first);
  EXPECT_GE(seconds, 0.99 * std::chrono::duration<double>(before_last - after_first).count());
  EXPECT_LE(seconds, 1.01 * std::chrono::duration<double>(after - before).count());
}

}  // namespace
}  // namespace rayfarm
