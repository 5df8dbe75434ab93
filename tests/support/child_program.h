// One of our programs as a child process, its output caught.
#pragma once
#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace rayfarm {

struct ProgramResult {
  int exit_code = -1;  // 128 + signal when a signal ended it, as a shell says
  std::string out, err;
};

class ChildProgram {
 public:
  /// `words`: program and arguments; a program without a slash lies beside the test. The environment is the
  /// test's with these changes.
  explicit ChildProgram(std::vector<std::string> words,
                        const std::map<std::string, std::string>& environment = {});
  ~ChildProgram();  // kills what still runs
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  /// Waits for one line of stdout; empty when it ended without.
  std::string next_line();
  void send_signal(int signal);
  /// Waits for its end; `out` lacks the lines already taken.
  ProgramResult result();

 private:
  pid_t pid_ = -1;
  int out_ = -1, err_ = -1;
};

inline ProgramResult run_program(std::vector<std::string> words,
                                 const std::map<std::string, std::string>& environment = {}) {
  return ChildProgram(std::move(words), environment).result();
}

}  // namespace rayfarm
