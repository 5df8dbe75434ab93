#include "master/pace.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

double seconds(FarmTime time) { return std::chrono::duration<double>(time).count(); }

TEST(Speed, IsUnknownBeforeTheFirstDelivery) { EXPECT_EQ(Speed().per_second(), 0); }

TEST(Speed, IsTheRateOfASteadyWorker) {
  Speed speed;
  for (int i = 0; i < 50; ++i) speed.add(1000, 20ms);
  EXPECT_NEAR(speed.per_second(), 50'000, 1);
}

TEST(Speed, FollowsAChangeWithinThirtyDeliveries) {
  Speed speed;
  for (int i = 0; i < 100; ++i) speed.add(1000, 20ms);
  for (int i = 0; i < 30; ++i) speed.add(1000, 200ms);
  EXPECT_NEAR(speed.per_second(), 5'000, 250);
}

TEST(Speed, SurvivesOneDeliveryOfAPcThatSlept) {
  Speed speed;
  for (int i = 0; i < 20; ++i) speed.add(1000, 20ms);
  speed.add(1000, 1h);
  EXPECT_GT(speed.per_second(), 20'000);
}

TEST(Speed, IsHardlyMovedByOneTinyFastDelivery) {
  Speed speed;
  for (int i = 0; i < 20; ++i) speed.add(1000, 20ms);
  speed.add(10, 0ns);
  EXPECT_NEAR(speed.per_second(), 50'000, 500);
}

TEST(Pace, IsUnknownBeforeTheFirstPixel) {
  Pace pace;
  EXPECT_EQ(pace.time_for(100, 5s), std::nullopt);
  pace.restart(0s, 0);
  EXPECT_EQ(pace.time_for(100, 5s), std::nullopt);
}

TEST(Pace, OfASteadyJobIsExact) {
  Pace pace;
  pace.restart(0s, 0);
  for (int i = 1; i <= 1000; ++i) {
    pace.advance(i * 50ms, 200u * i);
    EXPECT_NEAR(seconds(pace.time_for(4000, i * 50ms).value()), 1.0, 1e-6);
  }
}

TEST(Pace, ForgetsWhatIsOlderThanTenSecondsAndTenDeliveries) {
  Pace pace;
  pace.restart(0s, 0);
  std::uint64_t pixels = 0;
  for (int i = 1; i <= 600; ++i) pace.advance(i * 100ms, pixels += 1000);      // a minute, 10,000 a second
  for (int i = 1; i <= 120; ++i) pace.advance(60s + i * 100ms, pixels += 10);  // then a hundred a second
  EXPECT_NEAR(seconds(pace.time_for(1000, 72s).value()), 10.0, 0.1);
}

TEST(Pace, OfAJobWithRareDeliveriesSpansTenOfThem) {
  Pace pace;
  pace.restart(0s, 0);
  for (int i = 1; i <= 20; ++i) pace.advance(i * 60s, 100u * i);
  EXPECT_NEAR(seconds(pace.time_for(100, 20 * 60s).value()), 60.0, 1e-6);
  EXPECT_NEAR(seconds(pace.time_for(100, 20 * 60s + 30s).value()), 63.0,
              1e-6);  // no news is a little bad news
}

TEST(Pace, LearnsAnewAfterARestart) {
  Pace pace;
  pace.restart(0s, 0);
  pace.advance(1s, 1000);
  pace.restart(100s, 1000);
  EXPECT_EQ(pace.time_for(1000, 101s), std::nullopt);
  pace.advance(101s, 1500);
  EXPECT_NEAR(seconds(pace.time_for(1000, 101s).value()), 2.0, 1e-6);
}

}  // namespace
}  // namespace rayfarm
