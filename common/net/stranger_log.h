// What strangers make a log say: anybody can be refused as often as they like, and must not wash away what others did.
#pragma once
#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace rayfarm {

class StrangerLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// What is to be logged of this refusal: nothing when it is the last one again, or when there were ten in this minute;
  /// how many were left out the next line tells.
  std::optional<std::string> line_for(const std::string& refusal, Time now) {
    if (now - minute_ >= std::chrono::minutes(1)) minute_ = now, lines_ = 0;
    if (refusal == last_ || lines_ == most_lines) {
      ++untold_;
      return std::nullopt;
    }
    ++lines_;
    last_ = refusal;
    const std::size_t untold = std::exchange(untold_, 0);
    return untold == 0 ? refusal : refusal + " (and " + std::to_string(untold) + " more before it)";
  }

 private:
  static constexpr int most_lines = 10;  // a minute

  std::string last_;
  Time minute_{};
  int lines_ = 0;
  std::size_t untold_ = 0;
};

}  // namespace rayfarm
