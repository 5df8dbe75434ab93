#pragma once
#include <chrono>

namespace rayfarm {

/// The farm's time: since any fixed instant, never going back.
using FarmTime = std::chrono::nanoseconds;

}  // namespace rayfarm
