#include "tests/support/child_program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
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

/// Appends what is there to read; false at the end.
bool read_some(int descriptor, std::string& text) {
  char bytes[4096];
  const ssize_t n = ::read(descriptor, bytes, sizeof bytes);
  if (n > 0) text.append(bytes, static_cast<std::size_t>(n));
  return n > 0;
}

}  // namespace

ChildProgram::ChildProgram(std::vector<std::string> words,
                           const std::map<std::string, std::string>& environment) {
  int out[2], err[2];
  if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);

  words.front() = path_of(words.front());
  std::vector<std::string> variables = environment_with(environment);
  const int failed = ::posix_spawn(&pid_, words.front().c_str(), &actions, nullptr, pointers_to(words).data(),
                                   pointers_to(variables).data());
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(out[1]);
  ::close(err[1]);
  out_ = out[0], err_ = err[0];
  if (failed != 0) throw std::runtime_error("cannot start " + words.front());
}

ChildProgram::~ChildProgram() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  ::close(out_);
  ::close(err_);
}

std::string ChildProgram::next_line() {
  std::string line;
  for (char c = 0; ::read(out_, &c, 1) == 1 && c != '\n';) line += c;
  return line;
}

void ChildProgram::send_signal(int signal) { ::kill(pid_, signal); }

ProgramResult ChildProgram::result() {
  ProgramResult result;
  pollfd pipes[2]{{out_, POLLIN, 0}, {err_, POLLIN, 0}};
  while ((pipes[0].fd >= 0 || pipes[1].fd >= 0) && ::poll(pipes, 2, -1) > 0) {
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
