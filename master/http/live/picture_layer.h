// A picture of a job as a layer: tiles of its film, taken from the farm a few at a time.
#pragma once
#include "master/diagnostics/layer.h"
#include "master/http/farm_door.h"

namespace rayfarm {

/// The farm's thread is asked once a call, and copies no more than the tiles that are told; not even that once
/// the job is done: before, a worker may be found to have lied. The door must outlive the source.
LayerSource picture_layer(const FarmDoor& farm, JobId job, std::optional<std::uint32_t> frame);

}  // namespace rayfarm
