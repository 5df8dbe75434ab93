#include "master/files/atomic_write.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "master/files/image_file.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

const std::vector<std::uint8_t> four_bytes{1, 2, 3, 4};

/// No file of this process may grow beyond so many bytes while this lives: a full disk, in effect.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit small{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &old_); }

 private:
  rlimit old_{};
};

TEST(AtomicWrite, WritesTheBytesAndNothingElse) {
  const ScratchFolder folder;
  write_atomically(folder / "a", four_bytes);
  EXPECT_EQ(content_of(folder / "a"), std::string("\1\2\3\4"));
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicWrite, AFailedWriteLeavesTheOldFileAndNoOther) {
  const ScratchFolder folder;
  put_content(folder / "a", "old");
  {
    const FileSizeLimit full_disk(3);
    EXPECT_THROW(write_atomically(folder / "a", four_bytes), FileError);
  }
  EXPECT_EQ(content_of(folder / "a"), "old");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, AppearsWhenItIsCommittedWithWhatWasPutAtItsStartLast) {
  const ScratchFolder folder;
  put_content(folder / "a", "old");
  AtomicFile file(folder / "a");
  file.append(four_bytes);
  file.put_at_start(std::vector<std::uint8_t>{7, 8});
  file.append(std::vector<std::uint8_t>{5});
  EXPECT_EQ(content_of(folder / "a"), "old");
  file.commit();
  EXPECT_EQ(content_of(folder / "a"), std::string("\7\10\3\4\5"));
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, LeavesTheOldFileWhenItIsNotCommittedOrTheDiskIsFull) {
  const ScratchFolder folder;
  put_content(folder / "a", "old");
  { AtomicFile(folder / "a").append(four_bytes); }
  {
    AtomicFile file(folder / "a");
    const FileSizeLimit full_disk(6);
    file.append(four_bytes);
    EXPECT_THROW(file.append(four_bytes), FileError);
  }
  EXPECT_EQ(content_of(folder / "a"), "old");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicWrite, AFolderInTheWayStaysAndNothingIsLeftBeside) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "a");
  EXPECT_THROW(write_atomically(folder / "a", four_bytes), FileError);
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a"));
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicWrite, ASymbolicLinkStaysOneAndItsTargetIsReplaced) {
  const ScratchFolder folder;
  put_content(folder / "target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  write_atomically(folder / "link", four_bytes);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(content_of(folder / "target"), std::string("\1\2\3\4"));
}

TEST(AtomicWrite, RightsAreThoseOfTheOldFileOrOfTheUmask) {
  const ScratchFolder folder;
  put_content(folder / "old", "old");
  ::chmod((folder / "old").c_str(), 0640);
  const mode_t mask = ::umask(0027);
  write_atomically(folder / "old", four_bytes);
  write_atomically(folder / "new", four_bytes);
  ::umask(mask);
  EXPECT_EQ(static_cast<unsigned>(std::filesystem::status(folder / "old").permissions()), 0640u);
  EXPECT_EQ(static_cast<unsigned>(std::filesystem::status(folder / "new").permissions()), 0640u);
}

}  // namespace
}  // namespace rayfarm
