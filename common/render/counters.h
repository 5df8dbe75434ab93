// Exact counts of what a render did; sums are order-free, so a farm's equal a local render's.
#pragma once
#include <cstdint>

namespace rayfarm {

struct RayCounters {
  std::uint64_t primary = 0;  // rays by kind
  std::uint64_t reflected = 0;
  std::uint64_t refracted = 0;
  std::uint64_t shadow = 0;
  std::uint64_t primary_hits = 0;
  std::uint64_t secondary_hits = 0;  // of reflected and refracted rays
  std::uint64_t bad_samples = 0;     // NaN or infinite, made black where they entered the film
  std::uint64_t lost = 0;            // secondary rays that met what contradicts the side they were sent to

  bool operator==(const RayCounters&) const = default;
  RayCounters& operator+=(const RayCounters& o) {
    primary += o.primary, reflected += o.reflected, refracted += o.refracted, shadow += o.shadow;
    primary_hits += o.primary_hits, secondary_hits += o.secondary_hits, bad_samples += o.bad_samples;
    lost += o.lost;
    return *this;
  }
  /// What was counted since `o` was taken.
  RayCounters operator-(const RayCounters& o) const {
    return {primary - o.primary,           reflected - o.reflected,
            refracted - o.refracted,       shadow - o.shadow,
            primary_hits - o.primary_hits, secondary_hits - o.secondary_hits,
            bad_samples - o.bad_samples,   lost - o.lost};
  }
  std::uint64_t rays() const { return primary + reflected + refracted + shadow; }
  std::uint64_t misses() const { return primary + reflected + refracted - primary_hits - secondary_hits; }
};

}  // namespace rayfarm
