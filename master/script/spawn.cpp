#include "master/script/spawn.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds between_questions{100};

void require(int error, const char* what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  ~Descriptor() { close(); }
  int get() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }
  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_;
};

struct Pair {
  Descriptor ours, theirs;
};

/// A socket rather than a pipe: a write to a dead helper must not raise SIGPIPE here.
Pair socket_pair() {
  int fds[2];
  require(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, fds) == 0 ? 0 : errno, "socketpair");
  return {Descriptor(fds[0]), Descriptor(fds[1])};
}

/// A running helper; killed and reaped at the latest when this goes.
class Process {
 public:
  Process(const std::filesystem::path& program, int stdio, int talk) {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&files, stdio, 0);
    posix_spawn_file_actions_adddup2(&files, stdio, 1);
    posix_spawn_file_actions_adddup2(&files, talk, 2);
    posix_spawn_file_actions_addclosefrom_np(&files, 3);
    // A daemon may block or ignore signals; the helper starts afresh.
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

    std::string name = program.string();
    const std::array<char*, 2> arguments{name.data(), nullptr};
    const std::array<char*, 1> environment{nullptr};
    const int error =
        posix_spawn(&pid_, name.c_str(), &files, &attributes, arguments.data(), environment.data());
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    require(error, name.c_str());
  }
  ~Process() { end(); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Kills it if it still runs, and answers its wait status.
  int end() {
    if (pid_ <= 0) return status_;
    kill(pid_, SIGKILL);  // one that has ended already keeps its status
    while (waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {}
    pid_ = 0;
    return status_;
  }

 private:
  pid_t pid_ = 0;
  int status_ = 0;
};

/// Reads what is there; answers how much, 0 at the end, and counts an error as the end.
std::size_t read_some(int fd, std::array<char, 65536>& buffer) {
  const ssize_t n = read(fd, buffer.data(), buffer.size());
  if (n < 0 && errno == EINTR) return read_some(fd, buffer);
  return n < 0 ? 0 : static_cast<std::size_t>(n);
}

/// Carries bytes both ways until the helper closes its output. Answers why it ended otherwise, if it did.
HelperEnd converse(const HelperRun& run, Descriptor& stdio, Descriptor& talk) {
  HelperEnd end;
  std::array<char, 65536> buffer;
  std::string_view unsent = run.input;
  const Clock::time_point deadline = Clock::now() + run.wall;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return {HelperEnd::Kind::timed_out, 0, {}};
    if (run.stop && run.stop()) return {HelperEnd::Kind::stopped, 0, {}};
    const auto longest = run.stop ? std::min(left, between_questions.count()) : left;
    const short stdio_events = unsent.empty() ? POLLIN : POLLIN | POLLOUT;
    std::array<pollfd, 2> polled{{{stdio.get(), stdio_events, 0}, {talk.get(), POLLIN, 0}}};
    if (poll(polled.data(), polled.size(), static_cast<int>(std::min<decltype(left)>(longest, 1 << 30))) <
        0) {
      if (errno != EINTR) require(errno, "poll");
      continue;
    }
    if (polled[1].revents != 0) {
      const std::size_t n = read_some(talk.get(), buffer);
      if (n == 0) talk.close();
      if (n != 0 && run.on_talk) run.on_talk({buffer.data(), n});
    }
    if (polled[0].revents & POLLOUT) {
      const ssize_t n = send(stdio.get(), unsent.data(), unsent.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (n > 0) unsent.remove_prefix(static_cast<std::size_t>(n));
      if (unsent.empty()) shutdown(stdio.get(), SHUT_WR);
    }
    if (polled[0].revents & (POLLIN | POLLHUP | POLLERR)) {
      const std::size_t n = read_some(stdio.get(), buffer);
      if (n == 0) break;
      end.output.append(buffer.data(), n);
      if (end.output.size() > run.max_output) return {HelperEnd::Kind::output_too_long, 0, {}};
    }
  }
  return end;
}

}  // namespace

HelperEnd run_helper(const HelperRun& run) {
  Pair stdio = socket_pair(), talk = socket_pair();
  Process process(run.program, stdio.theirs.get(), talk.theirs.get());
  stdio.theirs.close();
  talk.theirs.close();
  HelperEnd end = converse(run, stdio.ours, talk.ours);
  const int status = process.end();
  if (end.kind != HelperEnd::Kind::exited) return end;
  if (WIFSIGNALED(status)) return {HelperEnd::Kind::signalled, WTERMSIG(status), std::move(end.output)};
  end.code = WEXITSTATUS(status);
  return end;
}

}  // namespace rayfarm
