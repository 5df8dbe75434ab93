#include "master/diagnostics/ticks.h"

#include <thread>

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

struct Look {
  Clock::time_point time;
  std::int64_t ticks;
};

/// At both at once: of some tries the one that took the least, for one may be interrupted in its middle.
Look look() {
  Look best{};
  Clock::duration least = Clock::duration::max();
  for (int i = 0; i < 8; ++i) {
    const Clock::time_point time = Clock::now();
    const std::int64_t count = ticks();
    const Clock::duration took = Clock::now() - time;
    if (took < least) best = {time, count}, least = took;
  }
  return best;
}

double measured_rate() {
  const Look first = look();
  std::this_thread::sleep_for(std::chrono::milliseconds(4));
  const Look last = look();
  return std::chrono::duration<double>(last.time - first.time).count() /
         static_cast<double>(last.ticks - first.ticks);
}

}  // namespace

double seconds_per_tick() {
  static const double rate = measured_rate();
  return rate;
}

}  // namespace rayfarm
