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
  if (!job) throw no_such_job(id);
  json object = to_json(*job, now);
  object["revision"] = farm.revision();
  return object;
}

ApiResponse show_job(const Call& call) {
  return shown(
      call.doors.farm.ask([id = job_id(call)](Farm& farm, FarmTime now) { return job_now(farm, id, now); }));
}

/// {scene_of: 7, ...}: the very scene of that job, with other settings.
JobSpec job_like_another(const json& body, const FarmDoor& farm) {
  for (const char* source : {"scene", "scene_name", "script", "script_name", "parameters"})
    if (body.contains(source)) throw ApiError(400, std::string(source) + " and scene_of exclude each other");
  if (!body["scene_of"].is_number_unsigned()) throw ApiError(400, "scene_of must be the number of a job");
  JobSpec spec = job_wishes(body);
  spec.settings = settings_from_json(body.value("settings", json::object()));
  JobSubject other = job_subject(farm, JobId{body["scene_of"].get<std::uint64_t>()});
  if (spec.name.empty()) spec.name = std::move(other.job.name);
  spec.parameters = std::move(other.job.parameters);
  spec.scene_hash = std::move(other.subject.scene_hash);
  spec.scene_bytes = std::move(other.subject.scene);
  return spec;
}

ApiResponse submit_job(const Call& call) {
  const json body = parse_json(call.request.body);
  JobSpec spec = body.contains("scene_of") ? job_like_another(body, call.doors.farm)
                                           : submitted_job(body, call.doors.scenes);
  ApiResponse response =
      shown(call.doors.farm.ask([spec = std::move(spec)](Farm& farm, FarmTime now) mutable {
        const JobId id = farm.submit(std::move(spec), now);
        return job_now(farm, id, now);
      }));
  response.status = 201;
  return response;
}

/// Runs change(farm, id, now), which says false when there is no such job or it has ended.
template <class Change>
ApiResponse change_job(const Call& call, Change change) {
  return shown(call.doors.farm.ask([id = job_id(call), change = std::move(change)](Farm& farm, FarmTime now) {
    const bool changed = change(farm, id, now);
    json job = job_now(farm, id, now);
    if (!changed) throw ApiError(409, text_of(id) + " has ended (" + job["state"].get<std::string>() + ")");
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

constexpr Route routes[]{
    {"GET", "/api/v1/jobs", list_jobs},
    {"POST", "/api/v1/jobs", submit_job, Work::script, submission_limit},
    {"GET", "/api/v1/jobs/{id}", show_job},
    {"POST", "/api/v1/jobs/{id}/pause", pause_job},
    {"POST", "/api/v1/jobs/{id}/resume", resume_job},
    {"POST", "/api/v1/jobs/{id}/cancel", cancel_job},
    {"POST", "/api/v1/jobs/{id}/priority", prioritise_job},
};

}  // namespace

std::span<const Route> job_routes() { return routes; }

}  // namespace rayfarm
