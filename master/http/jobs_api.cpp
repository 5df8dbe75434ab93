// Jobs: submitting, listing, steering.
#include <nlohmann/json.hpp>

#include "master/http/farm_json.h"
#include "master/http/job_subject.h"
#include "master/http/route.h"
#include "master/http/script_submission.h"
#include "master/http/settings_json.h"

namespace rayfarm {
namespace {

using nlohmann::json;

ApiResponse list_jobs(const Call& call) {
  return shown(call.doors.farm.ask([](Farm& farm, FarmTime now) {
    json jobs = json::array();
    for (const JobView& job : farm.jobs(now)) jobs.push_back(to_json(job, now));
    return json{{"revision", farm.revision()}, {"jobs", std::move(jobs)}};
  }));
}

/// The job as it is on the farm's thread.
json job_now(Farm& farm, JobId id, FarmTime now) {
  const std::optional<JobView> job = farm.job(id, now);
  if (!job) throw no_such_job(farm, id);
  json object = to_json(*job, now);
  object["revision"] = farm.revision();
  return object;
}

ApiResponse show_job(const Call& call) {
  return shown(
      call.doors.farm.ask([id = job_id(call)](Farm& farm, FarmTime now) { return job_now(farm, id, now); }));
}

/// {scene_of: 7, ...}: the very scene of that job, with other settings; of an animation that of settings.frame, or of
/// the first.
JobSpec job_like_another(const json& body, const FarmDoor& farm) {
  for (const char* source : {"scene", "scene_name", "script", "script_name", "parameters", "frames"})
    if (body.contains(source)) throw ApiError(400, std::string(source) + " and scene_of exclude each other");
  if (!body["scene_of"].is_number_unsigned()) throw ApiError(400, "scene_of must be the number of a job");
  JobSpec spec = job_wishes(body);
  const json settings = body.value("settings", json::object());
  spec.settings = settings_from_json(settings);
  const JobId id{body["scene_of"].get<std::uint64_t>()};
  JobSubject other = job_subject(farm, id, std::nullopt);
  if (other.job.frames.count() > 1) {
    const bool names_one = settings.contains("frame");
    spec.settings.frame = names_one ? spec.settings.frame : other.job.frames.first;
    other = job_subject(farm, id, spec.settings.frame);
  }
  if (spec.name.empty()) spec.name = std::move(other.job.name);
  spec.parameters = std::move(other.job.parameters);
  spec.scene_hash = std::move(other.subject.scene_hash);
  spec.scene_bytes = std::move(other.subject.scene);
  spec.assets = std::move(other.subject.assets);
  return spec;
}

ApiResponse submit_job(const Call& call) {
  const json body = parse_json(call.request.body);
  SubmittedJob job = body.contains("scene_of")
                         ? SubmittedJob{job_like_another(body, call.doors.farm), {}}
                         : submitted_job(body, call.doors.scenes, call.doors.assets, call.request.has_left);
  if (auto denial = denial_now(call.request)) return std::move(*denial);  // the script took its time
  const std::optional<FrameRange> frames = job.spec.frames;
  if (job.script && frames && frames->count() > 1) job.spec.script = kept_script(*job.script);
  // Fed where it is taken, as the answer may be that it is not on the disk yet.
  ApiResponse response = shown(call.doors.farm.order(
      [job = std::move(job), frames, &feeder = call.doors.feeder](Farm& farm, FarmTime now) mutable {
        const JobId id = farm.submit(std::move(job.spec), now);
        json submitted = job_now(farm, id, now);
        // One that was there already is fed already.
        if (job.script && frames && frames->count() > 1 && submitted["frames"]["sent"] == 1)
          feeder.feed(id, std::move(*job.script), *frames);
        return submitted;
      }));
  response.status = 201;
  return response;
}

ApiResponse list_frames(const Call& call) {
  return shown(call.doors.farm.ask([id = job_id(call)](Farm& farm, FarmTime now) {
    if (!farm.job(id, now)) throw no_such_job(farm, id);
    json frames = json::array();
    for (const FrameView& frame : farm.frames(id, now)) frames.push_back(to_json(frame));
    return json{{"frames", std::move(frames)}};
  }));
}

ApiResponse add_frame(const Call& call) {
  SubmittedFrame frame = frame_from_json(body_of(call), call.doors.assets);
  ApiResponse response =
      shown(call.doors.farm.order([id = job_id(call), frame = std::move(frame)](Farm& farm, FarmTime now) {
        const bool is_taken =
            farm.add_frame({id, frame.number}, frame.scene.hash, frame.scene.bytes, now, frame.assets);
        json job = job_now(farm, id, now);
        if (!is_taken)
          throw ApiError(409, text_of(id) + " has ended (" + job["state"].get<std::string>() + ")");
        return job;
      }));
  response.status = 201;
  return response;
}

/// Runs change(farm, id, now), which says false when there is no such job or it has ended.
template <class Change>
ApiResponse change_job(const Call& call, Change change) {
  return shown(
      call.doors.farm.order([id = job_id(call), change = std::move(change)](Farm& farm, FarmTime now) {
        const bool changed = change(farm, id, now);
        json job = job_now(farm, id, now);
        if (!changed)
          throw ApiError(409, text_of(id) + " has ended (" + job["state"].get<std::string>() + ")");
        return job;
      }));
}

ApiResponse pause_job(const Call& call) {
  return change_job(call, [](Farm& farm, JobId id, FarmTime now) { return farm.pause(id, now); });
}
ApiResponse resume_job(const Call& call) {
  return change_job(call, [](Farm& farm, JobId id, FarmTime now) { return farm.resume(id, now); });
}
ApiResponse cancel_job(const Call& call) {
  return change_job(call, [](Farm& farm, JobId id, FarmTime now) { return farm.cancel(id, now); });
}
ApiResponse prioritise_job(const Call& call) {
  const int priority = priority_from_json(body_of(call).value("priority", json()));
  return change_job(call,
                    [=](Farm& farm, JobId id, FarmTime now) { return farm.set_priority(id, priority, now); });
}

/// The job as it was.
ApiResponse remove_job(const Call& call) {
  return shown(call.doors.farm.order([id = job_id(call)](Farm& farm, FarmTime now) {
    json job = job_now(farm, id, now);
    if (!farm.remove(id))
      throw ApiError(409, text_of(id) + " is " + job["state"].get<std::string>() + ": cancel it first");
    return job;
  }));
}

constexpr Route routes[]{
    {"GET", "/api/v1/jobs?after&wait", list_jobs},
    {"POST", "/api/v1/jobs", submit_job, Work::script, submission_limit},
    {"GET", "/api/v1/jobs/{id}?after&wait", show_job},
    {"GET", "/api/v1/jobs/{id}/frames", list_frames},
    {"POST", "/api/v1/jobs/{id}/frames", add_frame, Work::script, submission_limit},
    {"POST", "/api/v1/jobs/{id}/pause", pause_job, Work::order},
    {"POST", "/api/v1/jobs/{id}/resume", resume_job, Work::order},
    {"POST", "/api/v1/jobs/{id}/cancel", cancel_job, Work::order},
    {"POST", "/api/v1/jobs/{id}/priority", prioritise_job, Work::order},
    {"POST", "/api/v1/jobs/{id}/remove", remove_job, Work::order},
};

}  // namespace

std::span<const Route> job_routes() { return routes; }

}  // namespace rayfarm
