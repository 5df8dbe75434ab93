// Time between two looks, as cheap as can be: a look at the clock of the system takes as long as a tenth of a ray.
#pragma once
#include <chrono>
#include <cstdint>
#ifdef __x86_64__
#include <x86intrin.h>
#endif

namespace rayfarm {

/// Of a counter that runs evenly, at a rate of its own: on x86-64 the processor's time-stamp counter.
inline std::int64_t ticks() {
#ifdef __x86_64__
  return static_cast<std::int64_t>(__rdtsc());
#else
  return std::chrono::steady_clock::now().time_since_epoch().count();
#endif
}

/// Its rate; the first call takes some milliseconds to measure it.
double seconds_per_tick();

}  // namespace rayfarm
