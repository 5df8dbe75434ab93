// How the command ends: a contract with scripts.
#pragma once
#include <stdexcept>
#include <string>

namespace rayfarm {

enum class ExitCode : int {
  done = 0,
  failed = 1,  // the render or the job
  usage = 2,   // also a bad scene or an output that cannot be written
  master_unreachable = 3,
  not_allowed = 4,
  timed_out = 5,
  version_refused = 6,
  partly_done = 7,  // a picture was written, some of its pixels are missing
  interrupted = 130,
};

/// Ends the command with this code, the message on stderr.
struct CommandError : std::runtime_error {
  CommandError(ExitCode code, const std::string& message) : std::runtime_error(message), code(code) {}
  ExitCode code;
};

}  // namespace rayfarm
