#include "master/http/job_subject.h"

#include "master/http/api_error.h"

namespace rayfarm {
namespace {

/// As it is on the farm's thread, if it can be looked into.
JobSubject open_frame(const Farm& farm, JobId id, std::optional<std::uint32_t> number, FarmTime now) {
  const FrameView frame = frame_view(farm, id, number, now);
  JobView job = *farm.job(id, now);
  const std::string what = text_of(id, number);
  if (frame.state == JobState::cancelled)
    throw ApiError(409, what + " was cancelled; submit it again to look into it");
  if (frame.state == JobState::failed) throw ApiError(409, what + " failed: " + job.message);
  if (frame.scene_hash.empty()) throw ApiError(409, "the scene of " + what + " has not come yet");
  const SharedBytes scene = farm.scene(id, number);
  if (!scene) throw ApiError(410, "the scene of " + what + " is no longer kept; submit it again");
  RenderSettings settings = job.settings;
  settings.frame = frame.frame;
  return {std::move(job), frame, {frame.scene_hash, scene, settings, farm.assets(id, number)}};
}

}  // namespace

std::string text_of(JobId id, std::optional<std::uint32_t> frame) {
  return (frame ? "frame " + std::to_string(*frame) + " of " : "") + text_of(id);
}

FrameView frame_view(const Farm& farm, JobId id, std::optional<std::uint32_t> number, FarmTime now) {
  const std::optional<JobView> job = farm.job(id, now);
  if (!job) throw no_such_job(farm, id);
  const std::optional<FrameView> frame = farm.frame(id, number, now);
  if (!frame) throw ApiError(404, "there is no " + text_of(id, number) + ", it has " + text_of(job->frames));
  return *frame;
}

JobSubject job_subject(const FarmDoor& farm, JobId id, std::optional<std::uint32_t> frame) {
  return farm.ask([=](Farm& f, FarmTime now) { return open_frame(f, id, frame, now); });
}

Deliveries job_deliveries(const FarmDoor& farm, JobId id, std::optional<std::uint32_t> frame) {
  return farm.ask([=](Farm& f, FarmTime now) {
    const RenderSettings settings = open_frame(f, id, frame, now).subject.settings;
    Deliveries none;
    none.tiles.resize(tile_count({settings.width, settings.height}));
    return f.deliveries(id, frame).value_or(std::move(none));
  });
}

}  // namespace rayfarm
