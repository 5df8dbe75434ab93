// A farm at work with its journal: what it cannot write down stops it, and is not forgotten.
#include "master/live_farm.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <optional>
#include <thread>

#include "master/journal/wal_sync.h"
#include "tests/master/farm/fake_worker.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size four_tiles{128, 128};

/// No file of this process can grow, as on a full disk.
class FullDisk {
 public:
  FullDisk() {
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit none{0, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

class LiveFarmTest : public testing::Test {
 protected:
  LiveFarmTest() { spdlog::set_level(spdlog::level::off); }
  ~LiveFarmTest() override { spdlog::set_level(spdlog::level::info); }

  std::filesystem::path journal() const { return folder / "journal.db"; }
  static JobId submit(LiveFarm& live) {
    return live.apply([](Farm& farm, FarmTime now) { return farm.submit(job_of(four_tiles), now); });
  }
  static JobView view(LiveFarm& live, JobId job) {
    return live.apply([&](Farm& farm, FarmTime now) { return farm.job(job, now).value(); });
  }
  static void resume(LiveFarm& live, JobId job) {
    live.apply([&](Farm& farm, FarmTime now) { return farm.resume(job, now); });
  }
  /// A worker comes, renders so many tiles and goes.
  static void render(LiveFarm& live, std::size_t tiles) {
    live.apply([&](Farm& farm, FarmTime now) {
      FakeWorker pc(farm, {.name = "pc"}, now);
      for (std::size_t i = 0; i < tiles; ++i) pc.finish_one(now);
      farm.remove_worker(pc.id(), "it has done enough", now);
    });
  }
  static bool is_as_it_must_be(LiveFarm& live, JobId job) {
    return live.apply(
        [&](Farm& farm, FarmTime) { return farm.film(job)->rgb() == made_up_picture(job, four_tiles); });
  }

  const ScratchFolder folder;
};

TEST_F(LiveFarmTest, TellsWhoWaitsOnceWhatChangedIsKept) {
  LiveFarm live;
  live.open(journal());
  int told = 0;
  const JobId job = live.apply([&](Farm& farm, FarmTime now) {
    live.once_kept([&](const std::optional<std::string>& fault) { told += fault ? 100 : 1; });
    return farm.submit(job_of(four_tiles), now);
  });
  EXPECT_EQ(told, 0);
  live.keep();
  EXPECT_EQ(told, 1);
  live.keep();
  EXPECT_EQ(told, 1);
  EXPECT_EQ(job, JobId{1});
}

TEST_F(LiveFarmTest, WaitsUntilWhatIsKeptIsSynced) {
  LiveFarm live;
  live.open(journal());
  for (int turn = 0; turn < 5; ++turn) {
    submit(live);
    live.keep();
    EXPECT_EQ(live.until_synced(), std::nullopt);
    SQLite::Database database(journal().string());
    EXPECT_EQ(marked_writes(journal()),
              database.execAndGet("SELECT value FROM facts WHERE name = 'writes'").getInt64());
  }
}

TEST_F(LiveFarmTest, SaysThatAnOrderIsNotKeptHoweverOftenItIsGivenUntilItIs) {
  LiveFarm live;
  live.open(journal());
  const auto fault = [&] {
    live.apply([](Farm& farm, FarmTime now) {
      JobSpec same = job_of(four_tiles);
      same.key = "mine";
      return farm.submit(std::move(same), now);
    });
    live.keep();
    return live.until_synced();
  };
  {
    const FullDisk full;
    EXPECT_TRUE(fault());
    EXPECT_TRUE(fault()) << "nothing is new, but it is not on the disk";
  }
  for (int tick = 0; tick < 10; ++tick) live.tick();
  EXPECT_EQ(fault(), std::nullopt) << "there is room again, which a tick sees";
}

TEST_F(LiveFarmTest, WaitsForAJournalThatIsAtSomethingElse) {
  LiveFarm live;
  live.open(journal());
  const JobId job = submit(live);
  bool is_told = false;
  live.once_kept([&](const auto& fault) { is_told = !fault; });
  {
    SQLite::Database other(journal().string(), SQLite::OPEN_READWRITE, 60'000);
    const SQLite::Transaction writing(other, SQLite::TransactionBehavior::IMMEDIATE);
    live.keep(), live.tick(), live.keep();
    EXPECT_FALSE(is_told);
    EXPECT_EQ(view(live, job).state, JobState::waiting);
  }
  live.tick();
  EXPECT_TRUE(is_told);
  EXPECT_EQ(view(live, job).state, JobState::waiting);
}

TEST_F(LiveFarmTest, GoesOnWhileSomebodyReadsItsJournal) {
  std::optional<SQLite::Database> reader;
  {
    LiveFarm live;
    live.open(journal());
    submit(live);
    live.keep();
    reader.emplace(journal().string(), SQLite::OPEN_READWRITE);
    reader->exec("BEGIN");
    reader->exec("SELECT * FROM jobs");
  }
  LiveFarm again;  // with the log of the other
  again.open(journal());
  const JobId job = submit(again);
  again.keep();
  for (int tick = 0; tick < 50; ++tick) again.tick(), std::this_thread::sleep_for(10ms);
  EXPECT_EQ(again.until_synced(), std::nullopt);
  EXPECT_EQ(view(again, job).state, JobState::waiting);
}

TEST_F(LiveFarmTest, DoesNotWaitForEverForAJournalThatSomebodyHasLocked) {
  LiveFarm live;
  live.open(journal());
  const JobId job = submit(live);
  std::optional<std::string> fault;
  live.once_kept([&](const auto& why) { fault = why; });
  {
    SQLite::Database other(journal().string(), SQLite::OPEN_READWRITE, 60'000);
    const SQLite::Transaction writing(other, SQLite::TransactionBehavior::IMMEDIATE);
    live.keep();
    for (int tick = 0; tick < 50 && !fault; ++tick) live.tick();
    ASSERT_TRUE(fault);
    EXPECT_NE(fault->find("locked"), std::string::npos);
    EXPECT_EQ(view(live, job).state, JobState::paused);
  }
  for (int tick = 0; tick < 10; ++tick) live.tick();
  EXPECT_EQ(live.until_synced(), std::nullopt);
}

TEST_F(LiveFarmTest, WritesAllChangesOfOneTurnAtItsEnd) {
  LiveFarm live;
  live.open(journal());
  int turns = 0;
  live.when_changed([&] { ++turns; });
  submit(live), submit(live);
  EXPECT_EQ(turns, 1);
  live.keep();
  render(live, 1);
  EXPECT_EQ(turns, 2);
}

TEST_F(LiveFarmTest, DeletesWhatWasDroppedFromTickToTick) {
  LiveFarm live;
  live.open(journal());
  const JobId job = live.apply([](Farm& farm, FarmTime now) {
    return farm.submit(job_of({1024, 1024}), now);
  });
  render(live, 256);
  live.keep();
  live.apply([&](Farm& farm, FarmTime) { return farm.remove(job); });
  live.keep();
  for (const int left : {256, 192, 128, 64, 0}) {
    EXPECT_EQ(SQLite::Database(journal().string()).execAndGet("SELECT count(*) FROM tiles").getInt(), left);
    live.tick();
  }
}

TEST_F(LiveFarmTest, ForgetsForGoodWhatIsTooOld) {
  JobId job{};
  {
    LiveFarm live(FarmLimits{.job_age = 1ns});
    live.open(journal());
    job = submit(live);
    render(live, 4);
    live.apply([](Farm& farm, FarmTime now) { farm.tick(now + 1ns); });
  }
  LiveFarm again;
  again.open(journal());
  EXPECT_TRUE(again.apply([&](Farm& farm, FarmTime) { return farm.was_here(job); }));
  EXPECT_GT(submit(again), job);
}

TEST_F(LiveFarmTest, PausesAllJobsOnAFullDiskAndSaysWhy) {
  LiveFarm live;
  live.open(journal());
  const JobId job = submit(live);
  live.keep();
  render(live, 1);
  std::optional<std::string> fault;
  live.once_kept([&](const auto& why) { fault = why; });
  {
    const FullDisk full;
    live.keep();
  }
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find(journal().string()), std::string::npos) << *fault;
  EXPECT_EQ(view(live, job).state, JobState::paused);
  EXPECT_EQ(view(live, job).message, *fault);
  EXPECT_EQ(live.log().after(0).back().event.text.find("paused") != std::string::npos, true);
}

TEST_F(LiveFarmTest, ForgetsNothingThatWasDoneOnAFullDisk) {
  JobId job{};
  {
    LiveFarm live;
    live.open(journal());
    job = submit(live);
    live.keep();
    {
      const FullDisk full;
      render(live, 2);
      live.keep();
      resume(live, job);
      live.keep();
      EXPECT_EQ(view(live, job).state, JobState::paused) << "the disk is still full";
    }
    live.keep();
    EXPECT_EQ(view(live, job).state, JobState::paused) << "until somebody looks after it";
    resume(live, job);
    live.keep();
    EXPECT_EQ(view(live, job).state, JobState::running);
    EXPECT_EQ(view(live, job).message, "");
    render(live, 1);
  }
  LiveFarm again;
  again.open(journal());
  EXPECT_EQ(view(again, job).pixels_done, 3 * 64u * 64u);
  render(again, 1);
  EXPECT_TRUE(is_as_it_must_be(again, job));
}

TEST_F(LiveFarmTest, GoesOnCountingTimeAfterItsEnd) {
  JobId job{};
  FarmTime before{};
  {
    LiveFarm live;
    live.open(journal());
    job = submit(live);
    before = view(live, job).submitted;
  }
  LiveFarm again;
  again.open(journal());
  EXPECT_EQ(view(again, job).submitted, before);
  again.apply([&](Farm&, FarmTime now) { EXPECT_GE(now, before); });
}

}  // namespace
}  // namespace rayfarm
