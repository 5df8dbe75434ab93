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
