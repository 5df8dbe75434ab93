#include "common/net/private_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace rayfarm {
namespace {

constexpr off_t largest = 64 << 20;  // bytes

[[noreturn]] void fail(const char* verb, const std::filesystem::path& file) {
  throw std::runtime_error(std::string("cannot ") + verb + " " + file.string() + ": " + std::strerror(errno));
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const { return number_; }

 private:
  const int number_;
};

void write_all(int descriptor, std::string_view content, const std::filesystem::path& file) {
  while (!content.empty()) {
    const ssize_t n = ::write(descriptor, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("write", file);
    content.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// What root puts into the folder of a service is the service's.
void give_to_owner_of_folder(int descriptor, const std::filesystem::path& file) {
  struct stat folder {};
  if (::geteuid() != 0 || ::stat(file.parent_path().c_str(), &folder) != 0) return;
  if (::fchown(descriptor, folder.st_uid, folder.st_gid) != 0) fail("give its owner", file);
}

}  // namespace

std::optional<std::string> read_private_file(const std::filesystem::path& file) {
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (in < 0 && errno == ENOENT) return std::nullopt;
  struct stat facts {};
  if (in < 0 || ::fstat(in, &facts) != 0) fail("read", file);
  if ((facts.st_mode & 077) != 0)
    throw std::runtime_error("other users of this PC may read " + file.string() + ": chmod 600 " +
                             file.string());
  if (facts.st_size > largest) throw std::runtime_error(file.string() + " is over 64 MB: it is not ours");
  std::string content(static_cast<std::size_t>(facts.st_size), '\0');
  std::size_t have = 0;
  while (have < content.size()) {
    const ssize_t n = ::read(in, content.data() + have, content.size() - have);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("read", file);
    if (n == 0) break;
    have += static_cast<std::size_t>(n);
  }
  content.resize(have);
  return content;
}

void write_private_file(const std::filesystem::path& file, const std::string& content) {
  const std::filesystem::path passing = file.string() + ".new";
  ::unlink(passing.c_str());  // of one that was killed
  {
    const Descriptor out(::open(passing.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
    if (out < 0) fail("write", passing);
    give_to_owner_of_folder(out, passing);
    write_all(out, content, passing);
    if (::fsync(out) != 0) fail("write", passing);
  }
  if (::rename(passing.c_str(), file.c_str()) != 0) fail("write", file);
  const Descriptor folder(::open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder >= 0) ::fsync(folder);  // some file systems cannot, and lose nothing by it
}

}  // namespace rayfarm
