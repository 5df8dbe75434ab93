// A scene as those see it who draw its solids, lights and camera in 3D.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "master/diagnostics/world_cache.h"

namespace rayfarm {

constexpr std::size_t most_solids_shown = 20'000;

/// Its camera, background, lights and solids; of more than so many solids the first, and "truncated" is true. A
/// solid's box holds what can be seen of it, and is null when that is endless or nothing; its matrix is the rows
/// of world_from_local.
nlohmann::json scene_view(const ReadyScene& scene);

}  // namespace rayfarm
