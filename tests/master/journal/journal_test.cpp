// What a farm kept in its journal is there again.
#include "master/journal/journal.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <random>

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

// It had stayed in the log for ever, for a checkpoint of a connection that has not read yet does nothing.
TEST(Journal, MovesALargeLogIntoItsFile) {
  KeptFarm kept;
  FakeWorker pc(kept.farm(), {.name = "pc"}, 1s);
  const auto size = [&] { return std::filesystem::file_size(kept.file()); };
  constexpr std::uintmax_t large = 4u << 20;
  for (int jobs = 0; jobs < 3000 && size() < large; ++jobs) {
    kept.farm().submit(job_of({512, 512}), 1s);
    pc.finish_all(1s);
    kept.keep();
  }
  EXPECT_GE(size(), large);
  Farm before = std::move(kept.farm());
  kept.close(), kept.open();
  EXPECT_TRUE(kept.opened().warnings.empty());
  expect_same(before, kept.farm(), 20s);
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
  SQLite::Database database(file.string(), SQLite::OPEN_READONLY, patience);
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

/// Of the file, once its log is in it.
std::int64_t bytes_of(const KeptFarm& kept) {
  SQLite::Database database(kept.file().string(), SQLite::OPEN_READONLY, patience);
  return database.execAndGet("PRAGMA page_count").getInt64() *
         database.execAndGet("PRAGMA page_size").getInt64();
}

/// Rows that no job needs.
std::int64_t orphans(const KeptFarm& kept) {
  return rows(kept.file(), "frames WHERE job NOT IN (SELECT id FROM jobs)") +
         rows(kept.file(), "tiles WHERE job NOT IN (SELECT id FROM jobs)") +
         rows(kept.file(), "pixels WHERE id NOT IN (SELECT id FROM tiles)") +
         rows(kept.file(), "uses WHERE job NOT IN (SELECT id FROM jobs)") +
         rows(kept.file(), "blobs WHERE hash NOT IN (SELECT hash FROM uses)");
}

/// With a scene of its own and an asset that it shares with every third one.
JobSpec nth_job(int n, std::size_t asset_bytes = 1000) {
  JobSpec spec = job_of(four_tiles, "picture", "scene " + std::to_string(n));
  spec.assets = {{"asset " + std::to_string(n % 3),
                  std::make_shared<const Bytes>(asset_bytes, static_cast<std::uint8_t>(n))}};
  return spec;
}

TEST(Journal, HoldsNothingThatNoJobNeedsWhateverJobsGo) {
  KeptFarm kept(FarmLimits{.film_bytes = 5 * 128 * 128 * 12, .jobs = 6, .job_age = 100s});
  std::mt19937 random(1);
  FarmTime now{};
  for (int life = 0; life < 5; ++life) {
    SCOPED_TRACE(life);
    FakeWorker pc(kept.farm(), {.name = "pc"}, now);
    for (int i = 0; i < 40; ++i) {
      const auto one_of = [&](std::uint64_t n) { return random() % n; };
      now += std::chrono::seconds(one_of(20));
      kept.farm().tick(now);
      if (one_of(3) != 0) kept.farm().submit(nth_job(i), now);
      const std::vector<JobView> jobs = kept.farm().jobs(now);
      if (jobs.empty()) continue;
      const JobId job = jobs[one_of(jobs.size())].id;
      if (one_of(4) == 0) kept.farm().remove(job);
      if (one_of(8) == 0) kept.farm().pause(job, now);
      if (one_of(8) == 0) kept.farm().cancel(job, now);
      for (std::uint64_t tiles = one_of(8); tiles > 0 && !pc.held().empty(); --tiles) pc.finish_one(now);
      kept.keep();
      ASSERT_EQ(orphans(kept), 0);
      ASSERT_EQ(rows(kept.file(), "jobs"), static_cast<std::int64_t>(kept.farm().jobs(now).size()));
    }
    kept.keep();
    Farm before = std::move(kept.farm());
    kept.crash();
    expect_same(before, kept.farm(), now);
  }
}

TEST(Journal, DoesNotGrowWhileJobsComeAndGo) {
  KeptFarm kept(FarmLimits{.jobs = 4});
  FakeWorker pc(kept.farm(), {.name = "pc"}, 1s);
  std::int64_t after_ten = 0;
  for (int n = 0; n < 60; ++n) {
    kept.farm().submit(nth_job(n, 1 << 20), 1s);
    pc.finish_all(1s);
    kept.keep();
    if (n == 10) after_ten = bytes_of(kept);
  }
  EXPECT_LE(bytes_of(kept), after_ten + (1 << 20));
}

TEST(Journal, GivesRoomBackWhenMuchOfItIsGone) {
  KeptFarm kept;
  FakeWorker pc(kept.farm(), {.name = "pc"}, 1s);
  for (int n = 0; n < 3; ++n) kept.farm().submit(nth_job(n, 16 << 20), 1s);
  const JobId last = kept.farm().submit(nth_job(3, 16 << 20), 1s);
  pc.finish_all(1s);
  kept.keep();
  const std::int64_t full = bytes_of(kept);
  EXPECT_GT(full, 48 << 20);
  for (int n = 1; n <= 3; ++n) kept.farm().remove(JobId(n));
  kept.keep();
  for (int n = 0; n < 60; ++n) {
    kept.farm().cancel(kept.farm().submit(job_of(four_tiles), 2s), 2s);
    kept.keep();
  }
  EXPECT_LT(bytes_of(kept), full - (12 << 20));
  kept.crash();
  EXPECT_EQ(kept.farm().film(last)->rgb(), made_up_picture(last, four_tiles));
  EXPECT_EQ(kept.farm().assets(last).at(0).bytes->size(), std::size_t{16} << 20);
}

TEST(Journal, DeletesALargePictureBitByBit) {
  constexpr Size many_tiles{1024, 1024};
  KeptFarm kept(FarmLimits{.film_bytes = 1});
  FakeWorker pc(kept.farm(), {.name = "pc"}, 1s);
  const JobId removed = kept.farm().submit(job_of(many_tiles), 1s);
  pc.finish_all(1s);
  kept.write();
  const JobId dropped = kept.farm().submit(job_of(many_tiles), 2s);
  pc.finish_all(2s);  // the first one's picture is dropped
  kept.farm().remove(removed);
  kept.write();
  const JobId last = kept.farm().submit(job_of({128, 128}), 3s);
  pc.finish_all(3s);
  kept.write();
  EXPECT_EQ(rows(kept.file(), "tiles"), 256 + 4 - 2 * 4);
  const JobView before = *kept.farm().job(dropped, 3s);

  kept.crash();
  EXPECT_TRUE(kept.opened().warnings.empty());
  EXPECT_FALSE(kept.farm().job(removed, 3s));
  EXPECT_EQ(kept.farm().film(dropped), nullptr);
  EXPECT_EQ(kept.farm().job(dropped, 3s)->counters, before.counters);
  for (const int left : {4 + 248 - 64, 4 + 184 - 64, 4 + 120 - 64, 4, 4}) {
    kept.keep();
    EXPECT_EQ(rows(kept.file(), "tiles"), left);
    EXPECT_EQ(rows(kept.file(), "pixels"), left);
  }
  EXPECT_EQ(rows(kept.file(), "waste"), 0);
  EXPECT_EQ(kept.farm().film(last)->rgb(), made_up_picture(last, {128, 128}));
}

TEST(Journal, TakesOverOneOfTheThirdVersion) {
  KeptFarm kept;
  live(kept.farm());
  kept.keep();
  const Farm before = std::move(kept.farm());
  kept.close();
  SQLite::Database(kept.file().string(), SQLite::OPEN_READWRITE)
      .exec("DROP TABLE waste; PRAGMA user_version = 3");
  kept.open();
  EXPECT_TRUE(kept.opened().warnings.empty());
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
    database.exec("DROP TABLE waste; DROP TABLE identities");
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
    database.exec("DROP TABLE waste; DROP TABLE identities");
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

// Only who brought a shared tile to its end was known after a restart; pieces of one who lied stayed.
TEST(Journal, KnowsAllWhoRenderedPiecesOfATile) {
  KeptFarm kept;
  const auto sharing = [](std::string name) {
    return WorkerInfo{.name = std::move(name), .threads = 4, .takes_pieces = true};
  };
  FakeWorker liar(kept.farm(), sharing("liar")), honest(kept.farm(), sharing("honest"));
  JobSpec two_frames = job_of({64, 64});
  two_frames.frames = FrameRange{0, 1, 1};  // one is still to come: the job goes on
  const JobId job = kept.farm().submit(std::move(two_frames), 1s);
  liar.finish_one(2s);
  kept.farm().remove_worker(liar.id(), "gone", 2s);
  honest.finish_all(3s);
  kept.keep();
  kept.crash();
  ASSERT_EQ(kept.farm().job(job, 4s)->pixels_done, 64u * 64);
  ASSERT_EQ(kept.farm().job(job, 4s)->tiles_shared, 1u);
  FakeWorker again(kept.farm(), sharing("liar"), 4s);
  Result lie;
  lie.lease = LeaseId{5};
  EXPECT_THROW(kept.farm().receive(again.id(), lie, 4s), WorkerError);
  EXPECT_EQ(kept.farm().job(job, 4s)->pixels_done, 0u);
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
