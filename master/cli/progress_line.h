// How far it is: one line redrawn on a terminal, a plain line each 10 % elsewhere. On stderr.
#pragma once
#include <chrono>
#include <optional>
#include <string>

namespace rayfarm {

class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();  // leaves the cursor on an empty line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// fraction: 0..1; details: what is counted, e.g. "412/650 tiles".
  void show(double fraction, const std::string& details, std::optional<std::chrono::seconds> eta);
  /// A line that stays, unless it is what was said last. Empty: nothing, and what was said may be said again.
  void say(const std::string& text);

 private:
  bool on_terminal_;
  bool drawn_ = false;
  int last_tenth_ = 0;
  std::string said_;
  std::chrono::steady_clock::time_point last_;
};

/// "[####......] 40%  details  ETA 00:41", as wide as the terminal allows.
std::string progress_text(double fraction, const std::string& details,
                          std::optional<std::chrono::seconds> eta, int columns);

}  // namespace rayfarm
