// What a render did, in exact numbers.
#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "common/geometry/csg.h"
#include "common/render/counters.h"
#include "common/render/settings.h"
#include "common/render/world.h"

namespace rayfarm {

struct Statistics {
  RayCounters rays;                 // as a render counts them
  std::vector<std::uint64_t> hits;  // by leaf: primary, reflected and refracted rays that met it first
  RayTests nearest_tests;           // what it took to find these hits
  RayTests shadow_tests;            // and what blocks the rays to the lights
  bool operator==(const Statistics&) const = default;
  /// Of another part of the picture.
  Statistics& operator+=(const Statistics& other);
};

/// The leaves that were hit, most hits first.
std::vector<std::size_t> leaves_hit(const Statistics& statistics);
/// {"nearest": {"rays", "boxes", .., "boxes_per_ray", ..}, "shadow": {..}}
nlohmann::json tests_json(const Statistics& statistics);

/// Of one tile's pixels; nothing when stop() said so.
std::optional<Statistics> statistics_of_tile(const World& world, const RenderSettings& settings,
                                             std::uint32_t tile, const std::function<bool()>& stop);

/// Renders the picture without keeping it. `progress` hears the tiles done and all tiles; nothing is returned
/// when stop() said so; it is asked from all threads.
std::optional<Statistics> statistics_of(
    const World& world, const RenderSettings& settings, unsigned threads, const std::function<bool()>& stop,
    const std::function<void(std::uint32_t done, std::uint32_t all)>& progress);

}  // namespace rayfarm
