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

  Farm farm_;
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

// A network that was away for two seconds had ended the job: five of those who held its first tiles, or pieces of one tile,
// were lost, or a tile went from one to the next of those who were lost, too, but not known to be.
TEST_F(Blame, WhenTheNetworkIsCutOffFromAWholeLabTheJobGoesOn) {
  std::vector<FakeWorker> lab;
  for (std::uint64_t i = 0; i < 40; ++i)
    lab.emplace_back(
        farm_,
        WorkerInfo{
            .name = "pc" + std::to_string(i), .threads = 1, .process = 100 + i, .takes_pieces = i < 20});
  FarmTime now = 3s;
  for (const FakeWorker& worker : lab) farm_.remove_worker(worker.id(), "silent for 2 s", now += 10ms, 2s);
  EXPECT_EQ(state(), JobState::running);
}

TEST_F(Blame, ASceneThatKillsAllWhoLoadItAtOnceFailsItsJob) {
  std::vector<FakeWorker> lab;
  for (int i = 0; i < 10; ++i)
    lab.emplace_back(farm_, WorkerInfo{.name = "pc" + std::to_string(i), .threads = 1});
  for (const FakeWorker& worker : lab) farm_.remove_worker(worker.id(), "connection reset", 1s);
  EXPECT_EQ(state(), JobState::failed);
}

/// A job of which all but one tile is done.
class BlameForPieces : public Blame {
 protected:
  BlameForPieces() {
    farm_.cancel(job_, 1s);
    shared_ = farm_.submit(job_of({2 * 64, 64}), 1s);
    FakeWorker first(farm_, {.name = "first", .threads = 2}, 1s);
    first.finish_one(2s);
    farm_.receive(first.id(), GiveBack{}, 2s);
    farm_.remove_worker(first.id(), "stopped", 2s);
  }
  FakeWorker sharing(int number, FarmTime now) {
    return {farm_, {.name = "pc" + std::to_string(number), .threads = 2, .takes_pieces = true}, now};
  }
  JobState state_of_shared() const { return farm_.job(shared_, 1s)->state; }

  JobId shared_{};
};

TEST_F(BlameForPieces, WhoAreLostTogetherWithPiecesOfOneTileFailNoJob) {
  std::vector<FakeWorker> lab;
  farm_.pause(shared_, 3s);
  for (int i = 0; i < 8; ++i) lab.push_back(sharing(i, 3s));
  farm_.resume(shared_, 3s);
  ASSERT_FALSE(lab.back().held().empty());
  for (const FakeWorker& worker : lab) farm_.remove_worker(worker.id(), "connection reset", 4s);
  EXPECT_EQ(state_of_shared(), JobState::running);
}

TEST_F(BlameForPieces, WhoAreLostOneAfterTheOtherWithPiecesOfOneTileFailIt) {
  FarmTime now = 3s;
  for (int i = 0; i < 20 && state_of_shared() == JobState::running; ++i) {
    const FakeWorker victim = sharing(i, now);
    ASSERT_FALSE(victim.held().empty());
    farm_.remove_worker(victim.id(), "connection reset", now += 100ms);
  }
  EXPECT_EQ(state_of_shared(), JobState::failed);
}

}  // namespace
}  // namespace rayfarm
