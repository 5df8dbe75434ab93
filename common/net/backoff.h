// How long to wait before the next attempt: twice as long each time, with jitter, so that a lab full of
// workers does not come back to a restarted master in one instant.
#pragma once
#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

namespace rayfarm {

struct BackoffTimes {
  std::chrono::milliseconds first{200}, longest{5000};
};

class Backoff {
 public:
  Backoff(BackoffTimes times, std::uint64_t seed) : times_(times), random_(seed), next_(times.first) {}

  /// Between half and all of a time that doubles.
  std::chrono::milliseconds next() {
    const auto most = std::exchange(next_, std::min(2 * next_, times_.longest));
    return std::chrono::milliseconds(std::uniform_int_distribution(most.count() / 2, most.count())(random_));
  }
  /// After a success.
  void reset() { next_ = times_.first; }

 private:
  BackoffTimes times_;
  std::mt19937_64 random_;
  std::chrono::milliseconds next_;
};

}  // namespace rayfarm
