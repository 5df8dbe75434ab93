#include "master/files/atomic_write.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "master/files/image_file.h"

namespace rayfarm {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file) {
  const int error = errno;
  throw FileError(
      "cannot write " + file.string() + ": " + std::strerror(error) +
      (error == ENOSPC || error == EDQUOT || error == EFBIG ? "; make room or choose another place" : ""));
}

/// A file of a passing name in the target's folder; gone again unless it was renamed.
class PassingFile {
 public:
  explicit PassingFile(const std::filesystem::path& target)
      : name_((target.parent_path() / ".rayfarm-XXXXXX").string()) {
    descriptor_ = ::mkostemp(name_.data(), O_CLOEXEC);
    if (descriptor_ < 0) fail(target);
  }
  ~PassingFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(name_.c_str());
  }
  PassingFile(const PassingFile&) = delete;
  PassingFile& operator=(const PassingFile&) = delete;

  bool write(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(descriptor_, bytes.data(), std::min<std::size_t>(bytes.size(), 1u << 30));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
  }
  /// The rights that open(2) would have given a new file, or those of the file it replaces.
  bool take_rights_of(const std::filesystem::path& target) {
    struct stat old {};
    if (::stat(target.c_str(), &old) == 0) return ::fchmod(descriptor_, old.st_mode & 0777) == 0;
    const mode_t mask = ::umask(0);
    ::umask(mask);
    return ::fchmod(descriptor_, 0666 & ~mask) == 0;
  }
  bool sync_and_rename(const std::filesystem::path& target) {
    if (::fsync(descriptor_) != 0) return false;
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0 || ::rename(name_.c_str(), target.c_str()) != 0) return false;
    return renamed_ = true;
  }

 private:
  std::string name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

/// The rename itself reaches the disk; some file systems cannot sync a folder, and lose nothing by it.
void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  std::error_code no_link;
  const bool is_link = std::filesystem::is_symlink(file, no_link);
  const std::filesystem::path target = is_link ? std::filesystem::weakly_canonical(file) : file;

  PassingFile passing(target);
  if (!passing.write(bytes) || !passing.take_rights_of(target) || !passing.sync_and_rename(target))
    fail(file);
  sync_folder(target.parent_path());
}

}  // namespace rayfarm
