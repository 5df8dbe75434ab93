#include "master/diagnostics/shelf.h"

#include <gtest/gtest.h>

#include "tests/support/hand_clock.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

struct ShelfOfLetters : testing::Test {
  HandClock clock;
  Shelf<char, char> shelf{{.bytes = 10, .wanted = 20, .things = 5}, clock.reader()};
  std::string made;

  void get(char key, std::uint64_t bytes) {
    EXPECT_EQ(*shelf.get(key, bytes,
                         [&] {
                           made += key;
                           return std::make_shared<char>(key);
                         }),
              key);
  }
  void let_go() { clock.turn(30s); }
};

TEST_F(ShelfOfLetters, MakesEachThingOnce) {
  get('a', 3), get('b', 3), get('a', 3), get('b', 3);
  EXPECT_EQ(made, "ab");
}

TEST_F(ShelfOfLetters, DropsWhatWasNotAskedForTheLongestWhenBytesRunOut) {
  get('a', 4), get('b', 4), get('a', 4);
  let_go();
  get('c', 4);
  get('a', 4);
  EXPECT_EQ(made, "abc");
  get('b', 4);
  EXPECT_EQ(made, "abcb");
}

TEST_F(ShelfOfLetters, DropsWhatWasNotAskedForTheLongestWhenThereAreTooMany) {
  for (const char key : {'a', 'b', 'c', 'd', 'e'}) get(key, 1);
  let_go();
  get('f', 1), get('b', 1);
  EXPECT_EQ(made, "abcdef");
  get('a', 1);
  EXPECT_EQ(made, "abcdefa");
}

TEST_F(ShelfOfLetters, KeepsWhatSomebodyLooksAtBeyondItsBytesButNotWithoutEnd) {
  get('a', 8), get('b', 8);
  get('a', 8), get('b', 8);
  EXPECT_EQ(made, "ab");
  EXPECT_THROW(get('c', 8), TooMuchAsked);
  let_go();
  get('c', 8);
  get('b', 8);
  EXPECT_EQ(made, "abcb");
}

TEST_F(ShelfOfLetters, TakesOneThingHoweverBig) {
  get('a', 1000);
  EXPECT_THROW(get('b', 1), TooMuchAsked);
  let_go();
  get('b', 1);
  EXPECT_EQ(made, "ab");
}

TEST_F(ShelfOfLetters, WhatIsOfferedGoesFirstAndTakesNobodysPlace) {
  const auto offer = [&](char key) { shelf.offer(key, 4, [&] { return std::make_shared<char>(key); }); };
  get('a', 4);
  offer('b'), offer('c');
  EXPECT_EQ(*shelf.find('b'), 'b');
  EXPECT_EQ(shelf.find('c'), nullptr);
  get('d', 4);  // at once: nobody has asked for b
  EXPECT_EQ(shelf.find('b'), nullptr);
  EXPECT_EQ(*shelf.find('a'), 'a');
  EXPECT_EQ(made, "ad");
}

TEST_F(ShelfOfLetters, WhatCouldNotBeMadeIsNotThere) {
  EXPECT_THROW(shelf.get('a', 9, []() -> std::shared_ptr<char> { throw std::bad_alloc(); }), std::bad_alloc);
  get('a', 9);
  EXPECT_EQ(made, "a");
}

}  // namespace
}  // namespace rayfarm
