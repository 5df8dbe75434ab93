// How fast things go, learned from what was delivered: a worker's speed and a job's time to go.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "master/farm_time.h"

namespace rayfarm {

/// Samples or rays a second of one thread, over the last ten or so deliveries. Weighted by time: a delivery counts
/// for as much as it took, so that the noise of tiny tiles does not.
class Speed {
 public:
  void add(std::uint64_t amount, FarmTime taken);
  /// 0: nothing learned yet.
  double per_second() const { return seconds_ > 0 ? amount_ / seconds_ : 0; }

 private:
  double amount_ = 0, seconds_ = 0;  // of all deliveries, each later one shrinking the earlier
};

/// Pixels a second of a job, over the last ten seconds or ten deliveries, whichever is longer.
class Pace {
 public:
  /// Forgets what was learned; time that passed before says nothing about the future (a pause).
  void restart(FarmTime now, std::uint64_t pixels_done);
  void advance(FarmTime now, std::uint64_t pixels_done);
  /// Until `pixels` more are there; nothing before there is something to learn from.
  std::optional<FarmTime> time_for(std::uint64_t pixels, FarmTime now) const;

 private:
  struct Mark {
    FarmTime at{};
    std::uint64_t pixels_done = 0;
  };
  std::deque<Mark> marks_;  // at least a second apart; the first is where the window opens
  std::uint64_t pixels_done_ = 0;
};

}  // namespace rayfarm
