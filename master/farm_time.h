#pragma once
#include <chrono>

namespace rayfarm {

/// The farm's time: since any fixed instant, never going back.
using FarmTime = std::chrono::nanoseconds;

inline double seconds_of(FarmTime time) { return std::chrono::duration<double>(time).count(); }

}  // namespace rayfarm
