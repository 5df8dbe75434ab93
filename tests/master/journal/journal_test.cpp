// What a farm kept in its journal is there again.
#include "master/journal/journal.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "common/net/codec.h"
#include "tests/master/farm/rebuilt_farm.h"
#include "tests/master/journal/kept_farm.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size four_tiles{128, 128};

JobSpec full_spec() {
  JobSpec spec = job_of(four_tiles, "picture", "scene");
  spec.script = std::string("return scene{}\0\xff", 16);
  spec.output = "out.####.exr", spec.key = "key", spec.priority = 7;
  spec.settings.seed = 42, spec.settings.shadows = false;
  spec.parameters = {{"depth", "6"}, {"light", "a line\nand another"}};
  spec.assets = {{"asset", std::make_shared<const Bytes>(Bytes{1, 2, 3})}};
  spec.frames = FrameRange{3, 9, 3};
  spec.verification = Audit{0.25};
  return spec;
}

/// A job done, one half done, one cancelled, one that waits with a frame of three; workers drained and banned.
void live(Farm& farm) {
  const JobId done = farm.submit(job_of(four_tiles), 1s);
  FakeWorker pc(farm, {.name = "pc", .threads = 3}, 2s), other(farm, {.name = "other"}, 2s);
  while (farm.job(done, 2s)->state != JobState::done) {
    if (!pc.held().empty()) pc.finish_one(3s, 0.5);
    if (!other.held().empty()) other.finish_one(4s, 0.25);
  }
  farm.submit(job_of({70, 150}), 5s);
  pc.finish_one(6s), other.finish_one(7s);
  const JobId cancelled = farm.submit(job_of(four_tiles, "third", "other scene"), 8s);
  farm.set_priority(cancelled, 99, 8s);
  other.finish_all(8s);
  farm.cancel(cancelled, 9s);
  farm.submit(full_spec(), 10s);
  farm.drain("pc", 11s), farm.ban("other", 11s);
}

TEST(Journal, GivesTheSameFarmAgainAfterACrashAndAfterACleanEnd) {
  for (const bool is_crash : {true, false}) {
    SCOPED_TRACE(is_crash);
    KeptFarm kept;
    live(kept.farm());
    kept.keep();
    Farm before = std::move(kept.farm());
    if (is_crash)
      kept.crash();
    else
      kept.close(), kept.open();
    EXPECT_TRUE(kept.opened().warnings.empty());
    expect_same(before, kept.farm(), 20s);
    EXPECT_EQ(kept.farm().assets(JobId{4}).size(), 1u);
    EXPECT_EQ(kept.farm().script(JobId{4}), full_spec().script);
    EXPECT_EQ(kept.farm().submit(full_spec(), 20s), JobId{4}) << "its key is known";
    FakeWorker pc(kept.farm(), {.name = "pc"}, 20s);
    EXPECT_EQ(kept.farm().workers().front().state, WorkerState::drained);
  }
}

TEST(Journal, KeepsWhatWasWrittenAndNothingElse) {
  KeptFarm kept;
  const JobId job = kept.farm().submit(job_of(four_tiles), 1s);
  FakeWorker pc(kept.farm(), {.name = "pc"}, 1s);
  pc.finish_one(2s);
  kept.keep();
  pc.finish_one(3s);
  kept.crash();
  EXPECT_EQ(kept.farm().job(job, 4s)->pixels_done, 64u * 64u);
  FakeWorker again(kept.farm(), {.name = "pc"}, 4s);
  again.finish_all(5s);
  EXPECT_EQ(kept.farm().film(job)->rgb(), made_up_picture(job, four_tiles));
  kept.keep();
  kept.crash();
  EXPECT_EQ(kept.farm().film(job)->rgb(), made_up_picture(job, four_tiles));
}

std::int64_t rows(const std::filesystem::path& file, const std::string& table) {
  SQLite::Database database(file.string());
  return database.execAndGet("SELECT count(*) FROM " + table).getInt64();
}

TEST(Journal, DeletesWhatTheFarmDrops) {
  KeptFarm kept(FarmLimits{.film_bytes = 1, .jobs = 2});
  FakeWorker pc(kept.farm(), {.name = "pc"}, 1s);
  for (int i = 0; i < 5; ++i) {
    kept.farm().submit(job_of(four_tiles, "picture", "scene " + std::to_string(i)), 2s);
    pc.finish_all(3s + std::chrono::seconds(i));
    kept.keep();
  }
  EXPECT_EQ(rows(kept.file(), "jobs"), 2);
  EXPECT_EQ(rows(kept.file(), "frames"), 2);
  EXPECT_EQ(rows(kept.file(), "tiles"), 4) << "of the newest picture";
  EXPECT_EQ(rows(kept.file(), "pixels"), 4);
  EXPECT_EQ(rows(kept.file(), "blobs"), 1);
  Farm before = std::move(kept.farm());
  kept.crash();
  expect_same(before, kept.farm(), 20s);
}

TEST(Journal, KnowsWhomToTrustAndWhatWasWasted) {
  KeptFarm kept;
  FakeWorker a(kept.farm(), {.name = "a"}), b(kept.farm(), {.name = "b"});
  JobSpec spec = job_of(four_tiles);
  spec.verification = Quorum{2};
  const JobId job = kept.farm().submit(spec, 0s);
  a.finish_one(1s), b.finish_one(2s), a.finish_one(3s), b.finish_one(4s);
  kept.farm().pause(job, 6s);
  const Trust trust = kept.farm().trust_in("a");
  EXPECT_GT(trust.good_in_a_row, 0u);
  const JobView before = *kept.farm().job(job, 6s);
  EXPECT_GT(before.time_wasted, 0s);
  kept.keep();
  kept.crash();
  EXPECT_EQ(kept.farm().trust_in("a"), trust);
  EXPECT_EQ(kept.farm().job(job, 6s)->verification, Verification(Quorum{2}));
  EXPECT_EQ(kept.farm().job(job, 6s)->tiles_checked, before.tiles_checked);
  EXPECT_EQ(kept.farm().job(job, 6s)->time_wasted, before.time_wasted);
}

TEST(Journal, TakesOverOneOfTheFirstVersion) {
  KeptFarm kept;
  live(kept.farm());
  kept.keep();
  const Farm before = std::move(kept.farm());
  kept.close();
  {
    SQLite::Database database(kept.file().string(), SQLite::OPEN_READWRITE);
    database.exec("DROP TABLE identities");
    database.exec("PRAGMA user_version = 1");
  }
  kept.open();
  EXPECT_TRUE(kept.opened().warnings.empty());
  expect_same(before, kept.farm(), 20s);
}

TEST(Journal, TakesOverWhomOneOfTheSecondVersionTrusted) {
  KeptFarm kept;
  FakeWorker(kept.farm(), {.name = "pc"});
  kept.keep();
  kept.close();
  {
    SQLite::Database database(kept.file().string(), SQLite::OPEN_READWRITE);
    database.exec("DROP TABLE identities");
    database.exec("ALTER TABLE workers ADD COLUMN good_in_a_row INTEGER NOT NULL DEFAULT 0");
    database.exec("ALTER TABLE workers ADD COLUMN mismatches INTEGER NOT NULL DEFAULT 0");
    database.exec("UPDATE workers SET good_in_a_row = 7, mismatches = 1");
    database.exec("PRAGMA user_version = 2");
  }
  kept.open();
  EXPECT_EQ(kept.farm().trust_in("pc"), (Trust{7, 1}));
}

TEST(Journal, KnowsAWorkerByItsCertificateWhateverItsName) {
  KeptFarm kept;
  {
    FakeWorker pc(kept.farm(), {.name = "pc", .certificate = "c0"});
    kept.farm().remove_worker(pc.id(), "gone", 1s);
    FakeWorker again(kept.farm(), {.name = "other", .certificate = "c0"}, 1s);
    kept.farm().ban("other", 1s);
  }
  kept.keep();
  kept.crash();
  EXPECT_TRUE(kept.farm().objection_to("third", "c0"));
  EXPECT_FALSE(kept.farm().objection_to("third", "c1"));
  kept.farm().unban("other", 2s);
  EXPECT_FALSE(kept.farm().objection_to("third", "c0"));
}

TEST(Journal, NamesAJobThatWasLiveAtTwoCrashesInARow) {
  KeptFarm kept;
  const JobId suspect = kept.farm().submit(job_of(four_tiles), 1s);
  const FakeWorker pc(kept.farm(), {.name = "pc"}, 1s);
  kept.farm().submit(job_of(four_tiles), 1s);
  kept.keep();
  kept.crash();
  EXPECT_TRUE(kept.opened().suspects.empty());
  kept.crash();
  EXPECT_EQ(kept.opened().suspects, std::vector<JobId>{suspect});
  kept.close(), kept.open();
  EXPECT_TRUE(kept.opened().suspects.empty()) << "a clean end begins anew";
}

}  // namespace
}  // namespace rayfarm
