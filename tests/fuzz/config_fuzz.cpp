// Configuration files of the daemons.
#include <sys/mman.h>
#include <unistd.h>

#include <iostream>

#include "common/daemon/command_line.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {
namespace {

/// A file without a name, with this content.
class MemoryFile {
 public:
  explicit MemoryFile(ByteView content) : file_(memfd_create("config", MFD_CLOEXEC)) {
    require(write(file_, content.data(), content.size()) == static_cast<ssize_t>(content.size()),
            "memory is there");
  }
  ~MemoryFile() { close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace

void fuzz(ByteView bytes) {
  std::cout.rdbuf(nullptr), std::cerr.rdbuf(nullptr);  // it tells people what is wrong
  const MemoryFile config(bytes);
  std::string arguments[] = {"daemon", "--config", config.path()};
  char* argv[] = {arguments[0].data(), arguments[1].data(), arguments[2].data(), nullptr};

  CLI::App app("daemon");
  Openness openness;
  std::string listen;
  unsigned threads = 1;
  std::vector<std::string> dial;
  declare_common_options(app, openness, "");
  app.add_option("--listen", listen);
  app.add_option("--threads", threads)->check(CLI::Range(1, 4096));
  app.add_option("--dial", dial);
  run_daemon(app, 3, argv, [] { return 0; });
}

}  // namespace rayfarm
