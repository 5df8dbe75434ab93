// A frame of a job, as diagnostics look into it.
#pragma once
#include "master/diagnostics/diagnostics.h"
#include "master/http/farm_door.h"

namespace rayfarm {

struct JobSubject {
  JobView job;
  FrameView frame;
  Subject subject;
};

/// Of a job's first frame, unless another is named. Throws ApiError when there is no such one, its scene has not
/// come or is no longer kept, or the job was cancelled or has failed before it was done.
JobSubject job_subject(const FarmDoor& farm, JobId id, std::optional<std::uint32_t> frame);
/// Who delivered the frame's pixels so far. Throws as job_subject().
Deliveries job_deliveries(const FarmDoor& farm, JobId id, std::optional<std::uint32_t> frame);
/// Throws ApiError when there is no such one.
FrameView frame_view(const Farm& farm, JobId id, std::optional<std::uint32_t> frame, FarmTime now);
/// "job 7", or "frame 12 of job 7" when one is named.
std::string text_of(JobId id, std::optional<std::uint32_t> frame);

}  // namespace rayfarm
