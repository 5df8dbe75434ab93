// The film of a job's frame (the first unless another is named), taken from the farm without holding its thread up.
#pragma once
#include <memory>

#include "master/files/image_file.h"
#include "master/http/farm_door.h"

namespace rayfarm {

/// On the farm's thread: null while nothing is rendered. Throws ApiError when there is no such job or its
/// film is no longer kept.
std::shared_ptr<const Film> film_so_far(const Farm& farm, JobId id, std::optional<std::uint32_t> frame,
                                        FarmTime now);

/// A film that no longer changes: a complete one is shared, a growing one copied a few milliseconds of the
/// farm's thread at a time, so that workers are not kept waiting by a look at a huge picture. Each tile is as
/// it was at some moment of the copying. Throws ApiError when there is none.
std::shared_ptr<const Film> film_snapshot(const FarmDoor& farm, JobId id, std::optional<std::uint32_t> frame);

/// What is there, coarse pixels filling the places of those to come; of a larger picture each n-th pixel.
Picture preview(const Film& film, std::uint32_t longest_side);

}  // namespace rayfarm
