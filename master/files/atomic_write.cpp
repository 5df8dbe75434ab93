#include "master/files/atomic_write.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "master/files/image_file.h"

namespace rayfarm {
namespace {

std::filesystem::path target_of(const std::filesystem::path& file) {
  std::error_code no_link;
  return std::filesystem::is_symlink(file, no_link) ? std::filesystem::weakly_canonical(file) : file;
}

/// The rename itself reaches the disk; some file systems cannot sync a folder, and lose nothing by it.
void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& file)
    : file_(file),
      target_(target_of(file)),
      passing_name_((target_.parent_path() / ".rayfarm-XXXXXX").string()) {
  descriptor_ = ::mkostemp(passing_name_.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail();
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!renamed_) ::unlink(passing_name_.c_str());
}

void AtomicFile::fail() const {
  const int error = errno;
  throw FileError(
      "cannot write " + file_.string() + ": " + std::strerror(error) +
      (error == ENOSPC || error == EDQUOT || error == EFBIG ? "; make room or choose another place" : ""));
}

void AtomicFile::append(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), std::min<std::size_t>(bytes.size(), 1u << 30));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail();
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

void AtomicFile::put_at_start(std::span<const std::uint8_t> bytes) {
  if (::lseek(descriptor_, 0, SEEK_SET) < 0) fail();
  append(bytes);
  if (::lseek(descriptor_, 0, SEEK_END) < 0) fail();
}

/// The rights that open(2) would have given a new file, or those of the file it replaces.
bool AtomicFile::take_rights_of_target() {
  struct stat old {};
  if (::stat(target_.c_str(), &old) == 0) return ::fchmod(descriptor_, old.st_mode & 0777) == 0;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return ::fchmod(descriptor_, 0666 & ~mask) == 0;
}

void AtomicFile::commit() {
  if (!take_rights_of_target() || ::fsync(descriptor_) != 0) fail();
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0 || ::rename(passing_name_.c_str(), target_.c_str()) != 0) fail();
  renamed_ = true;
  sync_folder(target_.parent_path());
}

void write_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  AtomicFile whole(file);
  whole.append(bytes);
  whole.commit();
}

}  // namespace rayfarm
