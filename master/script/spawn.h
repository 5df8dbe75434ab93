// Runs a helper program once: bytes in, bytes out, until a deadline.
#pragma once
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace rayfarm {

struct HelperRun {
  std::filesystem::path program;
  std::string_view input;             // on its standard input
  std::chrono::milliseconds wall{0};  // then it is killed
  std::size_t max_output = 0;         // bytes; one more and it is killed
  /// Called with what the helper writes to its standard error, as it comes.
  std::function<void(std::string_view)> on_talk;
  /// Asked ten times a second; the helper is killed when it says true. None: never.
  std::function<bool()> stop{};
};

struct HelperEnd {
  enum class Kind { exited, signalled, timed_out, output_too_long, stopped } kind = Kind::exited;
  int code = 0;        // exit code, or the signal's number
  std::string output;  // of its standard output
};

/// The helper has no files but its three standard streams, no environment, and is dead and reaped on return.
/// Throws std::system_error when it cannot be started.
HelperEnd run_helper(const HelperRun& run);

}  // namespace rayfarm
