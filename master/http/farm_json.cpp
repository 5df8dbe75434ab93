#include "master/http/farm_json.h"

#include <nlohmann/json.hpp>

#include "master/http/settings_json.h"

namespace rayfarm {
namespace {

using nlohmann::json;

/// Another one each time that a picture was done: what JavaScript's numbers hold exactly.
std::int64_t version_of(FarmTime done) {
  return std::chrono::duration_cast<std::chrono::microseconds>(done).count();
}

}  // namespace

json to_json(const JobView& job, FarmTime now) {
  return {{"id", static_cast<std::uint64_t>(job.id)},
          {"name", job.name},
          {"output", job.output},
          {"state", name_of(job.state)},
          {"message", job.message},
          {"priority", job.priority},
          {"scene_hash", job.scene_hash},
          {"settings", to_json(job.settings)},
          {"parameters", job.parameters},
          {"frames",
           {{"first", job.frames.first},
            {"last", job.frames.last},
            {"step", job.frames.step},
            {"total", job.frames.count()},
            {"sent", job.frames_sent},
            {"done", job.frames_done},
            {"current", job.current_frame ? json(*job.current_frame) : json()},
            {"version", version_of(job.last_done)}}},
          {"pixels_done", job.pixels_done},
          {"pixels_total", job.pixels_total},
          {"counters", to_json(job.counters)},
          {"age_seconds", seconds_of(now - job.submitted)},
          {"elapsed_seconds", seconds_of(job.elapsed)},
          {"eta_seconds", job.eta ? json(seconds_of(*job.eta)) : json()},
          {"tiles_given_back", job.tiles_given_back},
          {"tiles_doubled", job.tiles_doubled},
          {"tiles_shared", job.tiles_shared},
          {"verify", text_of(job.verification)},
          {"tiles_checked", job.tiles_checked},
          {"seconds_wasted", seconds_of(job.time_wasted)},
          {"rays_wasted", job.rays_wasted}};
}

json to_json(const FrameView& frame) {
  return {{"frame", frame.frame},
          {"state", name_of(frame.state)},
          {"is_kept", frame.is_kept},
          {"version", frame.done ? json(version_of(*frame.done)) : json()},
          {"scene_hash", frame.scene_hash},
          {"pixels_done", frame.pixels_done},
          {"pixels_total", frame.pixels_total},
          {"counters", to_json(frame.counters)},
          {"elapsed_seconds", seconds_of(frame.elapsed)},
          {"thread_seconds", seconds_of(frame.thread_time)}};
}

json to_json(const WorkerView& worker, FarmTime now) {
  return {{"name", worker.info.name},
          {"kind", worker.info.kind == WorkerKind::local ? "local" : "remote"},
          {"state", name_of(worker.state)},
          {"message", ""},
          {"address", worker.info.address},
          {"cpu", worker.info.cpu},
          {"version", worker.info.version},
          {"threads", worker.info.threads},
          {"leases", worker.leases},
          {"tiles", worker.tiles},
          {"pixels", worker.pixels},
          {"samples_per_second", worker.samples_per_second},
          {"age_seconds", seconds_of(now - worker.joined)}};
}

}  // namespace rayfarm
