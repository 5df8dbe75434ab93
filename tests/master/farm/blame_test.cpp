// A tile that kills whoever renders it must not kill a whole lab; a bad network must not end a job.
#include <gtest/gtest.h>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

class Blame : public testing::Test {
 protected:
  Blame() { job_ = farm_.submit(job_of({640, 64}), 0s); }

  /// A worker joins, gets the first tile and is lost with it.
  void join_and_be_lost(int name, std::uint64_t process) {
    FakeWorker worker(farm_, {.name = "pc" + std::to_string(name), .threads = 1, .process = process});
    farm_.remove_worker(worker.id(), "connection reset", 1s);
  }
  JobState state() const { return farm_.job(job_, 1s)->state; }

 protected:
  Farm farm_;

 private:
  JobId job_{};
};

TEST_F(Blame, AJobOverWhichFiveWorkersAreLostFails) {
  for (int i = 0; i < 4; ++i) join_and_be_lost(i, 100 + i);
  EXPECT_EQ(state(), JobState::running);
  join_and_be_lost(4, 104);
  EXPECT_EQ(state(), JobState::failed);
}

TEST_F(Blame, OneWorkerThatIsStartedAgainAndAgainIsOne) {
  for (int i = 0; i < 20; ++i) join_and_be_lost(0, 100 + i);
  EXPECT_EQ(state(), JobState::running);
}

TEST_F(Blame, WorkersThatComeBackAliveHaveOnlyLostTheNetwork) {
  for (int round = 0; round < 10; ++round)
    for (int i = 0; i < 4; ++i) join_and_be_lost(i, 100 + i);
  EXPECT_EQ(state(), JobState::running);
  for (int i = 0; i < 8; ++i) {
    join_and_be_lost(i, 100 + i % 2);  // known by the process, whatever the name
    join_and_be_lost(100 + i, 100 + i % 2);
  }
  EXPECT_EQ(state(), JobState::running);
}

TEST_F(Blame, OneWorkerThatTakesAnotherNameEachTimeIsOne) {
  for (int i = 0; i < 20; ++i) {
    const WorkerInfo info{
        .name = "pc" + std::to_string(i), .threads = 1, .process = 100u + i, .certificate = "c0"};
    const FakeWorker worker(farm_, info);
    farm_.remove_worker(worker.id(), "connection reset", 1s);
  }
  EXPECT_EQ(state(), JobState::running);
}

TEST_F(Blame, AWorkerThatIsHereOnAnotherConnectionIsAlive) {
  const FakeWorker here(farm_, {.name = "pc", .threads = 1, .process = 7});
  for (int i = 0; i < 20; ++i) join_and_be_lost(i, 7);
  EXPECT_EQ(state(), JobState::running);
}

}  // namespace
}  // namespace rayfarm
