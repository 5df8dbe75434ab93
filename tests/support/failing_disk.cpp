#include "tests/support/failing_disk.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/support/child_program.h"

namespace rayfarm {
namespace {

/// Who is not root becomes it in a world of its own.
bool unshare_mounts() {
  if (::unshare(CLONE_NEWNS) == 0) return true;
  const std::string user = std::to_string(::getuid()), group = std::to_string(::getgid());
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
  std::ofstream("/proc/self/uid_map") << "0 " + user + " 1";
  std::ofstream("/proc/self/setgroups") << "deny";
  std::ofstream("/proc/self/gid_map") << "0 " + group + " 1";
  return true;
}

bool enter_own_mounts() {
  return unshare_mounts() && ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
}

constexpr unsigned long ext4_shutdown = _IOR('X', 125, std::uint32_t);  // EXT4_IOC_SHUTDOWN
constexpr std::uint32_t without_its_log = 2;                            // EXT4_GOING_FLAGS_NOLOGFLUSH

void run(const std::vector<std::string>& words) {
  const ProgramResult result = run_program(words);
  if (result.exit_code != 0) throw std::runtime_error(words[0] + ": " + result.err);
}

}  // namespace

int enter_small_disk(const std::filesystem::path& folder, std::size_t bytes) {
  const std::string size = "size=" + std::to_string(bytes);
  const bool done = enter_own_mounts() && ::mount("none", folder.c_str(), "tmpfs", 0, size.c_str()) == 0;
  return done ? 0 : errno;
}

LoopDisk::LoopDisk(std::filesystem::path file, std::filesystem::path folder)
    : file_(std::move(file)), folder_(std::move(folder)) {
  constexpr std::uintmax_t size = 64u << 20;
  std::filesystem::create_directory(folder_);
  std::ofstream{file_};
  std::filesystem::resize_file(file_, size);
  run({"/usr/sbin/mkfs.ext4", "-q", file_});
}

int LoopDisk::enter() const {
  if (!enter_own_mounts()) return errno;
  try {
    mount();
  } catch (const std::runtime_error&) {
    return EPERM;
  }
  return 0;
}

void LoopDisk::mount() const { run({"/usr/bin/mount", "-o", "loop,errors=remount-ro", file_, folder_}); }

void LoopDisk::cut_power() const {
  const int opened = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  std::uint32_t how = without_its_log;
  const bool is_cut = opened >= 0 && ::ioctl(opened, ext4_shutdown, &how) == 0;
  const int error = errno;
  if (opened >= 0) ::close(opened);
  if (!is_cut) throw std::runtime_error(std::string("the power cannot be cut: ") + std::strerror(error));
}

void LoopDisk::turn_read_only() const {
  struct stat state {};
  ::stat(folder_.c_str(), &state);
  const std::string number = std::to_string(major(state.st_dev)) + ":" + std::to_string(minor(state.st_dev));
  const std::string device = std::filesystem::read_symlink("/sys/dev/block/" + number).filename();
  if (!(std::ofstream("/sys/fs/ext4/" + device + "/trigger_fs_error") << "a fault of the test").flush())
    throw std::runtime_error("the disk " + device + " cannot be made read-only");
}

void LoopDisk::mount_again() const {
  run({"/usr/bin/umount", folder_});
  mount();
}

}  // namespace rayfarm
