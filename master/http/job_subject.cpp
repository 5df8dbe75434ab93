#include "master/http/job_subject.h"

#include "master/http/api_error.h"

namespace rayfarm {
namespace {

/// The job as it is on the farm's thread, if it can be looked into.
JobView open_job(Farm& farm, JobId id, FarmTime now) {
  std::optional<JobView> job = farm.job(id, now);
  if (!job) throw no_such_job(id);
  if (job->state == JobState::cancelled)
    throw ApiError(409, text_of(id) + " was cancelled; submit it again to look into it");
  if (job->state == JobState::failed) throw ApiError(409, text_of(id) + " failed: " + job->message);
  if (!farm.scene(id))
    throw ApiError(410, "the scene of " + text_of(id) + " is no longer kept; submit it again");
  return std::move(*job);
}

}  // namespace

JobSubject job_subject(const FarmDoor& farm, JobId id) {
  return farm.ask([id](Farm& f, FarmTime now) {
    JobView job = open_job(f, id, now);
    Subject subject{job.scene_hash, f.scene(id), job.settings};
    return JobSubject{std::move(job), std::move(subject)};
  });
}

Deliveries job_deliveries(const FarmDoor& farm, JobId id) {
  return farm.ask([id](Farm& f, FarmTime now) {
    const JobView job = open_job(f, id, now);
    Deliveries none;
    none.tiles.resize(tile_count({job.settings.width, job.settings.height}));
    return f.deliveries(id).value_or(std::move(none));
  });
}

}  // namespace rayfarm
