#include "master/http/guests.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

TEST(Guests, TheOldestOfThoseWhoHoldMostGoes) {
  Guests guests;
  std::list<Guests::Stay> stays;
  for (const char* who : {"z", "a", "a", "b"}) stays.emplace_back(guests, -1).guest().who = who;
  const auto leaving = [&] {
    std::string all;
    for (const Guests::Stay& stay : stays) all += stay.guest().is_leaving ? 'x' : '.';
    return all;
  };
  EXPECT_TRUE(guests.send_away_one());
  EXPECT_EQ(leaving(), ".x..");
  EXPECT_TRUE(guests.send_away_one());
  EXPECT_EQ(leaving(), "xx..") << "all hold one: the oldest, whatever they are called";
  stays.pop_front();
  EXPECT_TRUE(guests.send_away_one());
  EXPECT_TRUE(guests.send_away_one());
  EXPECT_FALSE(guests.send_away_one());
  EXPECT_EQ(guests.count(), 3u);
}

}  // namespace
}  // namespace rayfarm
