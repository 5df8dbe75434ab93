// Maps of jobs for those who watch them come together.
#pragma once
#include "master/diagnostics/diagnostics.h"
#include "master/http/farm_door.h"

namespace rayfarm {

/// Each question keeps the map in the making, and throws what job_subject() throws. Farm and diagnostics
/// outlive it.
LayerSource map_layer(const FarmDoor& farm, Diagnostics& diagnostics, JobId id,
                      std::optional<std::uint32_t> frame, const MapRequest& request);

}  // namespace rayfarm
