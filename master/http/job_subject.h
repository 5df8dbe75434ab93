// A job, as diagnostics look into it.
#pragma once
#include "master/diagnostics/diagnostics.h"
#include "master/http/farm_door.h"

namespace rayfarm {

struct JobSubject {
  JobView job;
  Subject subject;
};

/// Throws ApiError when there is no such job, it was cancelled or has failed, or its scene is no longer kept.
JobSubject job_subject(const FarmDoor& farm, JobId id);
/// Who delivered the job's pixels so far. Throws as job_subject().
Deliveries job_deliveries(const FarmDoor& farm, JobId id);

}  // namespace rayfarm
