// A clock that tests turn by hand.
#pragma once
#include <atomic>
#include <chrono>
#include <functional>

namespace rayfarm {

class HandClock {
 public:
  void turn(std::chrono::nanoseconds by) { now_ += by.count(); }
  /// Must not outlive this.
  std::function<std::chrono::nanoseconds()> reader() {
    return [this] { return std::chrono::nanoseconds(now_); };
  }

 private:
  std::atomic<std::int64_t> now_{1};
};

}  // namespace rayfarm
