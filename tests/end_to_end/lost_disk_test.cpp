// A master whose disk loses its power or becomes read-only.
#include <SQLiteCpp/SQLiteCpp.h>

#include <random>

#include "master/journal/wal_sync.h"
#include "tests/end_to_end/farm_programs.h"
#include "tests/support/failing_disk.h"

namespace rayfarm {
namespace {

class LostDisk : public FarmPrograms {
 protected:
  void run_on_own_disk(const std::function<void()>& body) {
    run_apart([&] { return disk.enter(); }, body);
  }
  void start(const std::string& listen = "127.0.0.1:0") {
    start_master({"--threads", "0", "--state", mounted / "state"}, listen);
  }
  void start_with_worker() {
    start();
    start_worker("pc0");
    wait_for_workers(1);
  }
  void lose_power() {
    disk.cut_power();
    kill_master();
    disk.mount_again();
  }
  /// That the journal holds.
  std::int64_t writes() const {
    const SQLite::Database database(journal.string(), SQLite::OPEN_READWRITE, 10'000);
    SQLite::Statement statement(database, "SELECT value FROM facts WHERE name = 'writes'");
    statement.executeStep();
    return statement.getColumn(0);
  }

  const std::filesystem::path mounted = folder / "disk", journal = mounted / "state" / "journal.db";
  const LoopDisk disk{folder / "disk.img", mounted};
  const Words picture{scene_file("circus"), "--size", "512x384", "--spp", "16"};
};

TEST_F(LostDisk, KeepsWhatWasSyncedWhenThePowerFailsAtAnyMoment) {
  run_on_own_disk([&] {
    start_with_worker();
    const std::string id = submit(picture);
    std::mt19937 random(1);
    for (int turn = 0; turn < 5; ++turn) {
      SCOPED_TRACE(turn);
      const std::uint64_t enough = std::min<std::uint64_t>(pixels_of(id) + random() % 25'000, 512 * 384);
      wait_until("more of it is there", [&] { return pixels_of(id) >= enough; });
      const std::int64_t synced = marked_writes(journal);
      lose_power();
      EXPECT_GE(writes(), synced);
      start(farm_address());
      wait_for_workers(1);
      rayfarm({"resume", id});  // after two crashes in a row it waits
    }
    wait_for_state(id, "done");
    EXPECT_TRUE(fetched(id) == rendered_here(picture));
    EXPECT_EQ(log_of("master").find("damaged"), std::string::npos);
  });
}

TEST_F(LostDisk, HasEachJobThatSomebodyWasToldIsSubmitted) {
  run_on_own_disk([&] {
    start();
    for (int turn = 0; turn < 5; ++turn) {
      submit(picture);
      const std::string id = submit(picture);  // the first of some time is synced at once anyway
      EXPECT_EQ(rayfarm({"priority", id, "77"}).exit_code, 0);
      lose_power();
      start();
      EXPECT_EQ(job(id).at("priority"), 77);
    }
  });
}

TEST_F(LostDisk, ShowsWhatItShowedBeforeOnceThatWasSynced) {
  run_on_own_disk([&] {
    start_with_worker();
    const std::string id = submit(picture);
    wait_for_pixels(id);
    kill_worker("pc0");
    wait_until("its work is given back", [&] { return workers().empty(); });
    const std::uint64_t seen = pixels_of(id);
    wait_until("all is synced", [&] { return marked_writes(journal) >= writes(); });
    lose_power();
    start();
    EXPECT_EQ(pixels_of(id), seen);
  });
}

TEST_F(LostDisk, KnowsWhomItLetInAndWhomNotWhenThePowerFailsJustThen) {
  run_on_own_disk([&] {
    start();
    for (const char* name : {"lab1", "lab2"}) {
      const std::string code = rayfarm({"token", "new"}).out;
      const ProgramResult joined = run_program({"rayfarm-worker", "join", code.substr(0, code.find('\n')),
                                                "--name", name, "--state", folder / name});
      EXPECT_EQ(joined.exit_code, 0) << joined.err;
    }
    EXPECT_EQ(rayfarm({"token", "revoke", "lab2"}).exit_code, 0);
    lose_power();
    start(farm_address());
    for (const char* name : {"lab2", "lab1"}) start_worker_with(name, {"--state", folder / name});
    wait_for_workers(1);
    wait_until("the other is refused",
               [&] { return log_of("master").find("\"lab2\" is refused") != std::string::npos; });
    EXPECT_TRUE(is_here("lab1"));
  });
}

TEST_F(LostDisk, PausesItsJobsWhenItIsReadOnlyAndLosesNothing) {
  run_on_own_disk([&] {
    start_with_worker();
    const std::string id = submit(picture);
    wait_for_pixels(id);
    const std::int64_t synced = marked_writes(journal);
    disk.turn_read_only();
    wait_for_state(id, "paused");
    const std::string why = job(id).at("message");
    EXPECT_NE(why.find("mend the disk, then resume the job"), std::string::npos) << why;
    EXPECT_NE(rayfarm({"resume", id}).exit_code, 0);
    kill_master();
    disk.mount_again();
    EXPECT_GE(writes(), synced);
    start(farm_address());
    wait_for_workers(1);
    rayfarm({"resume", id});
    wait_for_state(id, "done");
    EXPECT_TRUE(fetched(id) == rendered_here(picture));
  });
}

}  // namespace
}  // namespace rayfarm
