// What a render did, in exact numbers.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "common/render/counters.h"
#include "common/render/settings.h"
#include "common/render/world.h"

namespace rayfarm {

struct Statistics {
  RayCounters rays;                 // as a render counts them
  std::vector<std::uint64_t> hits;  // by leaf: primary, reflected and refracted rays that met it first
  bool operator==(const Statistics&) const = default;
};

/// Renders the picture without keeping it. `progress` hears the tiles done and all tiles; nothing is returned
/// when stop() said so; it is asked from all threads.
std::optional<Statistics> statistics_of(
    const World& world, const RenderSettings& settings, unsigned threads, const std::function<bool()>& stop,
    const std::function<void(std::uint32_t done, std::uint32_t all)>& progress);

}  // namespace rayfarm
