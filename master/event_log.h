// The last events of the farm, numbered: what the browser shows of the log.
#pragma once
#include <deque>
#include <vector>

#include "master/farm.h"

namespace rayfarm {

struct LogLine {
  std::uint64_t number = 0;  // from 1, without gaps
  FarmTime when{};
  FarmEvent event;
};

class EventLog {
 public:
  void add(FarmEvent event, FarmTime now) { add({last_ + 1, now, std::move(event)}); }
  /// A line of another log that this one follows.
  void add(LogLine line) {
    last_ = line.number;
    lines_.push_back(std::move(line));
    if (lines_.size() > most_lines) lines_.pop_front();
  }
  /// Those of a greater number that are still kept.
  std::vector<LogLine> after(std::uint64_t number) const {
    std::vector<LogLine> lines;
    for (const LogLine& line : lines_)
      if (line.number > number) lines.push_back(line);
    return lines;
  }
  std::uint64_t last() const { return last_; }

 private:
  static constexpr std::size_t most_lines = 500;

  std::deque<LogLine> lines_;
  std::uint64_t last_ = 0;
};

}  // namespace rayfarm
