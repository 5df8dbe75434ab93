// One of our programs as a child process, its output caught. It ends with the test at the latest, also when that
// is killed.
#pragma once
#include <sys/types.h>
#include <chrono>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rayfarm {

/// How long a test waits for what programs do.
#ifdef RAYFARM_SANITIZED
constexpr std::chrono::minutes test_patience{20};
#else
constexpr std::chrono::minutes test_patience{2};
#endif

struct ProgramResult {
  int exit_code = -1;  // 128 + signal when a signal ended it, as a shell says
  std::string out, err;
};

class ChildProgram {
 public:
  /// `words`: program and arguments; a program without a slash lies beside the test. The environment is the
  /// test's with these changes. stderr goes to the end of `log`; it is caught when there is none.
  explicit ChildProgram(std::vector<std::string> words,
                        const std::map<std::string, std::string>& environment = {},
                        const std::filesystem::path& log = {});
  ~ChildProgram();  // kills what still runs
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  pid_t pid() const { return pid_; }
  /// Waits for one line of stdout; empty when it ended without, or none came for test_patience.
  std::string next_line();
  void send_signal(int signal);
  /// Waits for its end, and ends it itself after test_patience; `out` lacks the lines already taken.
  ProgramResult result();

 private:
  pid_t pid_ = -1;
  int out_ = -1, err_ = -1;  // the latter only when stderr is caught
};

inline ProgramResult run_program(std::vector<std::string> words,
                                 const std::map<std::string, std::string>& environment = {}) {
  return ChildProgram(std::move(words), environment).result();
}

}  // namespace rayfarm
