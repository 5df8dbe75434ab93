// Work for those who ask: who is served, when it rests, how it ends.
#include "master/diagnostics/background.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <future>
#include <stdexcept>

#include "tests/support/hand_clock.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

/// Without threads: the test does the parts, and each takes so long.
struct BackgroundTasks : testing::Test {
  HandClock clock;
  Background background{0, clock.reader()};
  std::vector<std::pair<char, std::uint32_t>> done;

  Background::TaskRef add(char name, std::uint32_t parts, std::chrono::nanoseconds each = 0s) {
    return background.add({parts, [=, this](std::uint32_t part, const Background::Stop&) {
                             clock.turn(each);
                             done.emplace_back(name, part);
                             return true;
                           }});
  }
  /// How many parts there were.
  int work() {
    int parts = 0;
    while (background.work_once()) ++parts;
    return parts;
  }
};

TEST_F(BackgroundTasks, DoesNothingThatNobodyAskedFor) {
  const auto task = add('a', 3);
  EXPECT_EQ(work(), 0);
  background.ask(task);
  EXPECT_EQ(work(), 3);
}

TEST_F(BackgroundTasks, DoesEachPartOnceInOrderAndSaysHowFarItIs) {
  const auto task = add('a', 4);
  for (const double share : {0.0, 0.25, 0.5, 0.75}) {
    const Standing standing = background.ask(task);
    EXPECT_EQ(standing.state, LayerProgress::making);
    EXPECT_EQ(standing.share_done, share);
    EXPECT_TRUE(background.work_once());
  }
  EXPECT_FALSE(background.work_once());
  EXPECT_EQ(background.ask(task).state, LayerProgress::done);
  EXPECT_EQ(background.ask(task).share_done, 1);
  EXPECT_EQ(done, (std::vector<std::pair<char, std::uint32_t>>{{'a', 0}, {'a', 1}, {'a', 2}, {'a', 3}}));
}

TEST_F(BackgroundTasks, RestsWhenNobodyHasAskedForAWhileAndGoesOnWhenSomebodyDoes) {
  const auto task = add('a', 100, 1s);
  background.ask(task);
  EXPECT_EQ(work(), 30);
  clock.turn(1h);
  EXPECT_EQ(work(), 0);
  EXPECT_EQ(background.ask(task).share_done, 0.3);
  EXPECT_EQ(work(), 30);
  while (background.ask(task).state == LayerProgress::making) work();
  EXPECT_EQ(done.size(), 100u);
}

TEST_F(BackgroundTasks, ServesTheOneAskedForLast) {
  const auto a = add('a', 3), b = add('b', 2);
  background.ask(a), background.ask(b);
  background.work_once();
  background.ask(a);
  background.work_once();
  background.ask(b);
  work();
  std::string order;
  for (const auto& [name, part] : done) order += name;
  EXPECT_EQ(order, "babaa");
}

TEST_F(BackgroundTasks, APartInWorkIsStoppedWhenNobodyWantsItAndDoneAgain) {
  int calls = 0;
  const auto task = background.add({1, [&](std::uint32_t, const Background::Stop& stop) {
                                      EXPECT_FALSE(stop());
                                      if (++calls == 2) return true;
                                      clock.turn(30s);
                                      EXPECT_TRUE(stop());
                                      return false;
                                    }});
  background.ask(task);
  EXPECT_EQ(work(), 1);
  EXPECT_EQ(background.ask(task).state, LayerProgress::making);
  EXPECT_EQ(work(), 1);
  EXPECT_EQ(background.ask(task).state, LayerProgress::done);
}

TEST_F(BackgroundTasks, WhatFailsSaysWhyAndIsTriedAgainLater) {
  int calls = 0;
  const auto task = background.add({2, [&](std::uint32_t, const Background::Stop&) {
                                      if (++calls == 1) throw std::runtime_error("no luck");
                                      return true;
                                    }});
  background.ask(task);
  EXPECT_EQ(work(), 1);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(background.ask(task).state, LayerProgress::failed);
    EXPECT_EQ(background.ask(task).message, "no luck");
    EXPECT_EQ(work(), 0);
  }
  clock.turn(30s);
  EXPECT_EQ(background.ask(task).state, LayerProgress::making);
  EXPECT_EQ(work(), 2);
  EXPECT_EQ(background.ask(task).state, LayerProgress::done);
}

TEST_F(BackgroundTasks, WhatIsDoneOrDroppedHoldsNothingMore) {
  const auto held = std::make_shared<int>();
  const auto hold = [held](std::uint32_t, const Background::Stop&) { return *held == 0; };
  auto finished = background.add({1, hold}), dropped = background.add({1, hold});
  background.ask(finished);
  work();
  background.ask(dropped);
  dropped.reset();
  EXPECT_EQ(work(), 0);
  EXPECT_EQ(held.use_count(), 2) << "the test's own";
}

TEST(BackgroundThreads, HaveTheLowestPriority) {
  std::promise<int> niceness;
  Background background(1);
  const auto task =
      background.add({1, [&](std::uint32_t, const Background::Stop&) {
                        niceness.set_value(getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())));
                        return true;
                      }});
  background.ask(task);
  EXPECT_EQ(niceness.get_future().get(), 19);
  EXPECT_LT(getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())), 19) << "the others keep theirs";
}

TEST(BackgroundThreads, DoTheirPartsAtTheSameTime) {
  std::promise<void> first, second;
  Background background(2);
  const auto task = background.add({2, [&](std::uint32_t part, const Background::Stop&) {
                                      (part == 0 ? first : second).set_value();
                                      (part == 0 ? second : first).get_future().wait();
                                      return true;
                                    }});
  background.ask(task);
  while (background.ask(task).state == LayerProgress::making) std::this_thread::yield();
  EXPECT_EQ(background.ask(task).state, LayerProgress::done);
}

TEST(BackgroundThreads, EndInTheMiddleOfAPart) {
  std::promise<void> begun;
  Background background(1);
  const auto task = background.add({1, [&](std::uint32_t, const Background::Stop& stop) {
                                      begun.set_value();
                                      while (!stop()) std::this_thread::yield();
                                      return false;
                                    }});
  background.ask(task);
  begun.get_future().wait();
}

}  // namespace
}  // namespace rayfarm
