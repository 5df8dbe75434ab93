#include "tests/support/child_program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace rayfarm {
namespace {

std::string path_of(const std::string& program) {
  if (program.find('/') != std::string::npos) return program;
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / program).string();
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environment_with(const std::map<std::string, std::string>& changes) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (!changes.contains(text.substr(0, text.find('=')))) all.push_back(text);
  }
  for (const auto& [name, value] : changes) all.push_back(name + "=" + value);
  return all;
}

using Clock = std::chrono::steady_clock;

int milliseconds_until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
  return static_cast<int>(std::max(left.count(), std::chrono::milliseconds::rep{0}));
}

/// Appends what is there to read; false at the end.
bool read_some(int descriptor, std::string& text) {
  char bytes[4096];
  const ssize_t n = ::read(descriptor, bytes, sizeof bytes);
  if (n > 0) text.append(bytes, static_cast<std::size_t>(n));
  return n > 0;
}

/// Between fork and exec: only what a child of a program with threads may do.
[[noreturn]] void become(char* const* words, char* const* variables, int out, int err, pid_t test) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != test) ::_exit(127);  // it ended just before
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  ::execve(words[0], words, variables);
  ::_exit(127);
}

}  // namespace

ChildProgram::ChildProgram(std::vector<std::string> words,
                           const std::map<std::string, std::string>& environment,
                           const std::filesystem::path& log) {
  int out[2], err[2]{-1, -1};
  if (::pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  if (log.empty() && ::pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  if (!log.empty()) err[1] = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);

  words.front() = path_of(words.front());
  std::vector<std::string> variables = environment_with(environment);
  const std::vector<char*> argv = pointers_to(words), envp = pointers_to(variables);
  const pid_t test = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) become(argv.data(), envp.data(), out[1], err[1], test);
  ::close(out[1]);
  ::close(err[1]);
  out_ = out[0], err_ = err[0];
  if (pid_ < 0) throw std::runtime_error("cannot start " + words.front());
}

ChildProgram::~ChildProgram() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  ::close(out_);
  if (err_ >= 0) ::close(err_);
}

std::string ChildProgram::next_line() {
  const auto deadline = Clock::now() + test_patience;
  std::string line;
  pollfd pipe{out_, POLLIN, 0};
  while (::poll(&pipe, 1, milliseconds_until(deadline)) > 0) {
    char c = 0;
    if (::read(out_, &c, 1) != 1 || c == '\n') break;
    line += c;
  }
  return line;
}

void ChildProgram::send_signal(int signal) { ::kill(pid_, signal); }

ProgramResult ChildProgram::result() {
  ProgramResult result;
  pollfd pipes[2]{{out_, POLLIN, 0}, {err_, POLLIN, 0}};
  const auto deadline = Clock::now() + test_patience;
  while (pipes[0].fd >= 0 || pipes[1].fd >= 0) {
    if (::poll(pipes, 2, milliseconds_until(deadline)) == 0) {
      ::kill(pid_, SIGKILL);
      result.err += "\nkilled by the test: it did not end\n";
      break;
    }
    if (pipes[0].revents != 0 && !read_some(out_, result.out)) pipes[0].fd = -1;
    if (pipes[1].revents != 0 && !read_some(err_, result.err)) pipes[1].fd = -1;
  }
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace rayfarm
