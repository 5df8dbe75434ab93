#include "master/state_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace rayfarm {

StateFolder::StateFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::filesystem::path file = folder / "lock";
  if (!error) lock_ = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  if (lock_ < 0)
    throw std::runtime_error("the state folder " + folder.string() +
                             " cannot be used: " + (error ? error.message() : std::strerror(errno)) +
                             "; choose another with --state");
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    close(lock_);
    throw std::runtime_error("the state folder " + folder.string() +
                             " belongs to a master that is running: stop it, or choose another with --state");
  }
}

StateFolder::~StateFolder() { close(lock_); }

}  // namespace rayfarm
