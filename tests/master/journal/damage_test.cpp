// Journals that cannot be used, and parts of them that are damaged: told, never shown.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "tests/master/farm/rebuilt_farm.h"
#include "tests/master/journal/kept_farm.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size four_tiles{128, 128};

std::string refusal_of(const std::filesystem::path& file) try {
  Journal journal(file);
  journal.read();
  return "";
} catch (const JournalError& error) {
  return error.what();
}

TEST(DamagedJournal, IsRefusedWhenItIsNoJournalOrANewerOne) {
  const ScratchFolder folder;
  put_content(folder / "noise", std::string(8192, 'x'));
  EXPECT_NE(refusal_of(folder / "noise").find("move it away"), std::string::npos);
  { Journal made(folder / "newer"); }
  SQLite::Database((folder / "newer").string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99");
  EXPECT_NE(refusal_of(folder / "newer").find("newer rayfarm"), std::string::npos);
  EXPECT_NE(refusal_of(folder / "missing" / "journal").find("--state"), std::string::npos);
}

TEST(DamagedJournal, IsMadeWholeWhenItWasHalfMade) {
  const ScratchFolder folder;
  put_content(folder / "empty", "");
  EXPECT_EQ(refusal_of(folder / "empty"), "");
  EXPECT_EQ(refusal_of(folder / "empty"), "");
}

/// A finished job, then these words of SQL to its journal; and the farm again.
struct Damaged {
  explicit Damaged(const std::string& sql) {
    job = kept.farm().submit(job_of(four_tiles), 1s);
    FakeWorker(kept.farm(), {.name = "pc"}, 1s).finish_all(2s);
    kept.keep();
    kept.close();
    SQLite::Database(kept.file().string(), SQLite::OPEN_READWRITE, patience).exec(sql);
    kept.open();
  }
  JobView view() { return kept.farm().job(job, 3s).value(); }
  void expect_done_when_resumed() {
    ASSERT_TRUE(kept.farm().resume(job, 4s));
    FakeWorker pc(kept.farm(), {.name = "pc"}, 4s);
    EXPECT_EQ(pc.held().size(), 1u) << "only what was damaged";
    pc.finish_all(5s);
    kept.keep();
    kept.crash();
    EXPECT_EQ(kept.farm().job(job, 6s)->state, JobState::done);
    EXPECT_EQ(kept.farm().film(job)->rgb(), made_up_picture(job, four_tiles));
  }
  KeptFarm kept;
  JobId job{};
};

constexpr auto flip = "substr(data, 1, 20) || x'5a' || substr(data, 22)";

TEST(DamagedJournal, RendersDamagedPixelsAgain) {
  Damaged damaged(std::string("UPDATE pixels SET data = CAST(") + flip + " AS BLOB) WHERE id = 2");
  EXPECT_EQ(damaged.kept.farm().film(damaged.job)->pixels_done(), 3 * 64u * 64u);
  EXPECT_EQ(damaged.view().state, JobState::paused);
  damaged.expect_done_when_resumed();
}

TEST(DamagedJournal, RendersTilesAgainWhoseRecordsAreDamaged) {
  Damaged damaged("UPDATE tiles SET body = zeroblob(108) WHERE id = 3");
  EXPECT_EQ(damaged.view().state, JobState::paused);
  EXPECT_EQ(damaged.view().pixels_done, 3 * 64u * 64u);
  EXPECT_FALSE(damaged.kept.opened().warnings.empty());
  damaged.expect_done_when_resumed();
}

TEST(DamagedJournal, DoesNotTakeTheRowOfAnotherTile) {
  Damaged damaged("UPDATE pixels SET data = (SELECT data FROM pixels WHERE id = 1) WHERE id = 2");
  EXPECT_EQ(damaged.kept.farm().film(damaged.job)->pixels_done(), 3 * 64u * 64u);
  damaged.expect_done_when_resumed();
}

TEST(DamagedJournal, NamesAJobThatIsLost) {
  Damaged damaged(std::string("UPDATE jobs SET spec = x'00112233445566'"));
  EXPECT_FALSE(damaged.kept.farm().job(damaged.job, 3s));
  ASSERT_FALSE(damaged.kept.opened().warnings.empty());
  EXPECT_NE(damaged.kept.opened().warnings.front().find("job 1 is lost"), std::string::npos);
}

TEST(DamagedJournal, NoticesThatItsLogLostItsEnd) {
  KeptFarm kept;
  const JobId job = kept.farm().submit(job_of(four_tiles), 1s);
  FakeWorker pc(kept.farm(), {.name = "pc"}, 1s);
  kept.keep();
  for (int i = 0; i < 4; ++i) pc.finish_one(2s), kept.keep();
  kept.crash([](std::string& log) { log[log.size() * 3 / 4] ^= 1; });
  EXPECT_TRUE(kept.opened().is_cut);
  EXPECT_NE(kept.opened().warnings.at(0).find("damaged"), std::string::npos);
  EXPECT_LT(kept.farm().film(job)->pixels_done(), 4 * 64u * 64u);
  kept.crash();
  EXPECT_FALSE(kept.opened().is_cut) << "it is told once";
}

/// What a farm of today makes of the journal: a job anew, and all that is left done, as often as it must be started again.
void work_on(KeptFarm& kept, int starts) {
  for (int start = 0;; ++start) try {
      ASSERT_LE(start, starts) << "it goes on for ever";
      if (start > 0) kept.close(), kept.open(10s);
      for (const JobView& job : kept.farm().jobs(10s)) kept.farm().film(job.id);
      kept.keep();
      for (const JobView& job : kept.farm().jobs(10s)) kept.farm().resume(job.id, 10s);
      const JobId added = kept.farm().submit(job_of(four_tiles), 10s);
      FakeWorker(kept.farm(), {.name = "pc"}, 10s).finish_all(11s);
      kept.keep();
      kept.farm().remove(added);
      kept.keep(), kept.keep();
      return;
    } catch (const JournalError&) {}
}

TEST(DamagedJournal, GoesOnWhateverPageOfItsFileIsDamaged) {
  constexpr Size picture{384, 384};
  constexpr std::size_t page_size = 4096;
  std::vector<std::size_t>
      worst;  // pages with which more than one picture went: those that list all jobs and frames
  // All of the tables' first pages, and of their leaves some: most of them are pixels.
  for (std::size_t page = 1, pages = 2; page < pages; page += page < 24 ? 1 : 5) {
    SCOPED_TRACE("page " + std::to_string(page + 1));
    KeptFarm kept;
    FakeWorker pc(kept.farm(), {.name = "pc"}, 1s);
    std::vector<JobId> jobs;
    for (int i = 0; i < 3; ++i) {
      jobs.push_back(kept.farm().submit(job_of(picture), 1s));
      pc.finish_all(2s);
      kept.keep();
    }
    kept.close();
    std::string bytes = content_of(kept.file());
    pages = bytes.size() / page_size;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(page * page_size), page_size, '\0');
    put_content(kept.file(), bytes);

    kept.open(10s);
    work_on(kept, 2);
    kept.close(), kept.open(20s);
    std::size_t whole = 0;
    for (const JobId job : jobs) {
      if (!kept.farm().job(job, 20s)) continue;
      const auto film = kept.farm().film(job);
      whole += film && film->is_complete() && film->rgb() == made_up_picture(job, picture);
    }
    if (whole < 2) worst.push_back(page);
    kept.close(), kept.open(30s);
    for (const std::string& warning : kept.opened().warnings)
      EXPECT_EQ(warning, "the scene or asset scene was damaged on the disk") << "the rest is mended";
  }
  EXPECT_LE(worst.size(), 2u) << testing::PrintToString(worst);
}

/// One of the pages that hold this table, root first, is made of noughts.
void damage_page_of(const std::filesystem::path& file, const std::string& table) {
  constexpr std::size_t page_size = 4096;
  std::size_t root = 0;
  {
    SQLite::Database database(file.string(), SQLite::OPEN_READWRITE, patience);
    SQLite::Statement found(database, "SELECT rootpage FROM sqlite_master WHERE name = ?");
    found.bind(1, table);
    found.executeStep();
    root = static_cast<std::size_t>(found.getColumn(0).getInt());
  }
  std::string bytes = content_of(file);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>((root - 1) * page_size), page_size, '\0');
  put_content(file, bytes);
}

TEST(DamagedJournal, GivesNoPixelsOfAnotherJobToATileThatLostItsOwn) {
  KeptFarm kept;
  const JobId first = kept.farm().submit(job_of(four_tiles), 1s);
  FakeWorker(kept.farm(), {.name = "pc"}, 1s).finish_all(2s);
  kept.keep();
  kept.close();
  damage_page_of(kept.file(), "pixels");
  kept.open(3s);  // mended
  kept.farm().submit(job_of(four_tiles, "other", "another scene"), 4s);
  FakeWorker(kept.farm(), {.name = "pc"}, 4s).finish_all(5s);
  kept.keep();
  kept.close(), kept.open(6s);
  const auto film = kept.farm().film(first);
  EXPECT_TRUE(!film || std::ranges::count(film->rgb(), 0.0f) == std::ssize(film->rgb()));
}

TEST(DamagedJournal, KeepsThePlacesOfFramesThatAreLost) {
  KeptFarm kept;
  JobSpec animation = job_of({64, 64});
  animation.frames = FrameRange{0, 299, 1};
  const JobId job = kept.farm().submit(animation, 1s);
  for (std::uint32_t frame = 1; frame < 300; ++frame)
    kept.farm().add_frame({job, frame}, animation.scene_hash, animation.scene_bytes, 1s, {});
  FakeWorker(kept.farm(), {.name = "pc"}, 1s).finish_all(2s);
  kept.keep();
  kept.close();
  {
    SQLite::Database database(kept.file().string(), SQLite::OPEN_READWRITE, patience);
    database.exec("DELETE FROM frames WHERE frame BETWEEN 100 AND 150");
  }
  kept.open(3s);
  for (const std::uint32_t frame : {99u, 151u, 299u})
    EXPECT_TRUE(kept.farm().film(job, frame)->rgb() == made_up_picture(job, {64, 64}, frame)) << frame;
  kept.farm().resume(job, 4s);
  FakeWorker(kept.farm(), {.name = "pc"}, 4s).finish_all(5s);
  kept.keep();
  kept.close(), kept.open(6s);
  EXPECT_TRUE(kept.farm().job(job, 6s));
}

TEST(DamagedJournal, IsMendedOnceAndTheDamagedOneKept) {
  KeptFarm kept;
  kept.farm().submit(job_of(four_tiles), 1s);
  kept.keep();
  kept.close();
  const std::string name = kept.file().string();
  for (const char* damaged : {".damaged", ".damaged2"}) {
    damage_page_of(kept.file(), "workers");
    kept.open(2s);
    EXPECT_EQ(kept.opened().warnings.size(), 1u);
    EXPECT_EQ(kept.farm().jobs(2s).size(), 1u);
    EXPECT_TRUE(std::filesystem::exists(name + damaged));
    EXPECT_EQ(std::filesystem::status(name).permissions(), std::filesystem::perms(0600));
    kept.close(), kept.open(3s);
    EXPECT_TRUE(kept.opened().warnings.empty());
    kept.close();
  }
  // As when the process ended between two steps: the new file is whole, the log of the old one still there.
  std::filesystem::copy_file(name, name + "-mended");
  put_content(name + "-mended-is-whole", "");
  put_content(name, "what is left of the old one"), put_content(name + "-wal", "its log");
  kept.open(4s);
  EXPECT_EQ(kept.farm().jobs(4s).size(), 1u);
}

TEST(DamagedJournal, NeverShowsAWrongPixelWhateverBytesAreWrong) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    KeptFarm kept;
    const JobId job = kept.farm().submit(job_of(four_tiles), 1s);
    FakeWorker(kept.farm(), {.name = "pc"}, 1s).finish_all(2s);
    kept.keep();
    kept.close();
    std::string bytes = content_of(kept.file());
    for (int i = 0; i < 20; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
    put_content(kept.file(), bytes);
    try {
      kept.open();
    } catch (const JournalError&) {
      continue;  // told
    }
    const auto film = kept.farm().film(job);
    if (!film) continue;
    const auto picture = made_up_picture(job, four_tiles);
    for (std::size_t i = 0; i < picture.size(); ++i)
      ASSERT_TRUE(film->rgb()[i] == picture[i] || film->rgb()[i] == 0)
          << "a pixel is there or not, never wrong";
    EXPECT_EQ(kept.farm().job(job, 3s)->state == JobState::done, film->is_complete());
  }
}

}  // namespace
}  // namespace rayfarm
