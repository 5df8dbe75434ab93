// How a job's picture came about: its statistics, its scene, the rays behind a pixel.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "master/diagnostics/diagnostics.h"
#include "master/diagnostics/scene_view.h"
#include "master/http/job_subject.h"
#include "master/http/query.h"
#include "master/http/settings_json.h"

namespace rayfarm {
namespace {

using nlohmann::json;

// Statistics. ----------------------------------------------------------------------------------------------

constexpr std::size_t most_solids_listed = 20'000;

/// The solids that were hit, most hits first.
json json_of_hits(const Statistics& statistics, const std::vector<std::string>& names) {
  std::vector<std::size_t> leaves = leaves_hit(statistics);
  leaves.resize(std::min(leaves.size(), most_solids_listed));
  json hits = json::array();
  for (const std::size_t leaf : leaves)
    hits.push_back({{"leaf", leaf}, {"name", names[leaf]}, {"hits", statistics.hits[leaf]}});
  return hits;
}

/// What must be traced again to be known.
json statistics_detail(const Call& call, JobId id, std::optional<std::uint32_t> frame) try {
  const Subject subject = job_subject(call.doors.farm, id, frame).subject;
  const Made<Statistics> made = call.doors.diagnostics.statistics(subject);
  if (made.standing.state == LayerProgress::failed)
    return {{"state", "unavailable"}, {"message", made.standing.message}};
  if (!made.thing) return {{"state", "making"}, {"progress", made.standing.share_done}};
  return {{"state", "done"},
          {"progress", 1},
          {"counters", to_json(made.thing->rays)},
          {"tests", tests_json(*made.thing)},
          {"hits", json_of_hits(*made.thing, call.doors.diagnostics.scene(subject)->leaf_names())}};
} catch (const ApiError& error) {
  return {{"state", "unavailable"}, {"message", error.what()}};
}

/// Exact, of what is there.
struct RayFacts {
  bool is_one_frame = true;
  std::uint64_t pixels = 0;
  RayCounters counters;
  FarmTime waited{}, elapsed{}, thread_time{};
  // Known of jobs only.
  std::optional<FarmTime> wasted{};
  std::uint64_t rays_wasted = 0;
};

/// Of a frame, or of all of the job's when none is named.
RayFacts ray_facts(const FarmDoor& farm, JobId id, std::optional<std::uint32_t> number) {
  return farm.ask([=](Farm& f, FarmTime now) {
    const FrameView frame = frame_view(f, id, number, now);
    if (number)
      return RayFacts{true,         frame.pixels_done, frame.counters,
                      frame.waited, frame.elapsed,     frame.thread_time};
    const JobView job = *f.job(id, now);
    return RayFacts{job.frames.count() == 1, job.pixels_done, job.counters,   job.waited, job.elapsed,
                    job.thread_time,         job.time_wasted, job.rays_wasted};
  });
}

ApiResponse show_statistics(const Call& call) {
  const JobId id = job_id(call);
  const std::optional<std::uint32_t> frame = whole_in(call, "frame");
  const RayFacts facts = ray_facts(call.doors.farm, id, frame);
  const auto seconds = [](FarmTime time) { return std::chrono::duration<double>(time).count(); };
  const auto pixels = static_cast<double>(std::max<std::uint64_t>(facts.pixels, 1));
  json counters = to_json(facts.counters), mean;
  for (const auto& [name, total] : counters.items()) mean[name] = total.get<double>() / pixels;
  json detail = facts.is_one_frame
                    ? statistics_detail(call, id, frame)
                    : json{{"state", "unavailable"}, {"message", "hits are told frame by frame"}};
  const bool is_complete = detail["state"] != "making";
  json times{{"waiting", seconds(facts.waited)},
             {"rendering", seconds(facts.elapsed)},
             {"threads", seconds(facts.thread_time)}};
  if (facts.wasted) times["wasted"] = seconds(*facts.wasted);
  json statistics{{"counters", counters},
                  {"mean_per_pixel", mean},
                  {"pixels", facts.pixels},
                  {"samples_per_pixel", static_cast<double>(facts.counters.primary) / pixels},
                  {"seconds", std::move(times)},
                  {"detail", std::move(detail)}};
  if (facts.wasted) statistics["rays_wasted"] = facts.rays_wasted;
  ApiResponse response = shown(std::move(statistics));
  if (!is_complete) response.status = 202;
  return response;
}

// The scene. -----------------------------------------------------------------------------------------------

ApiResponse show_scene(const Call& call) {
  const Subject subject = job_subject(call.doors.farm, job_id(call), whole_in(call, "frame")).subject;
  return shown(scene_view(*call.doors.diagnostics.scene(subject)));
}

// The rays behind a pixel. ---------------------------------------------------------------------------------

std::uint32_t coordinate_in(const Call& call, const std::string& name) {
  const auto value = whole_in(call, name);
  if (!value) throw ApiError(400, "x and y say which pixel is traced; " + name + " is missing");
  return *value;
}

PixelTrace trace_of(const Call& call, const Subject& subject) try {
  const Pixel pixel{coordinate_in(call, "x"), coordinate_in(call, "y")};
  const SampleChoice choice = sample_choice(text_in(call, "sample").value_or("0"), subject.settings);
  return call.doors.diagnostics.trace(subject, pixel, choice, whole_in(call, "story").value_or(0));
} catch (const SettingsError& error) {
  throw ApiError(400, error.what());
}

ApiResponse show_trace(const Call& call) {
  enum class Format { json, svg, text };
  const auto format = choice_in(call, "format", "json", "json, svg or text",
                                [](const std::string& text) -> std::optional<Format> {
                                  if (text == "json") return Format::json;
                                  if (text == "svg") return Format::svg;
                                  return text == "text" ? std::optional(Format::text) : std::nullopt;
                                });
  const PixelTrace trace =
      trace_of(call, job_subject(call.doors.farm, job_id(call), whole_in(call, "frame")).subject);
  if (format == Format::svg) return {200, "image/svg+xml", svg_of(trace)};
  if (format == Format::text) return {200, "text/plain; charset=utf-8", text_of(trace)};
  return shown(to_json(trace));
}

// Clouds. --------------------------------------------------------------------------------------------------

CloudRequest cloud_request(const Call& call) {
  CloudRequest request;
  request.points = whole_in(call, "points", {1, most_cloud_points}).value_or(request.points);
  request.options.voxel = real_in(call, "voxel").value_or(0);
  if (request.options.voxel < 0) throw ApiError(400, "voxel must be a size, or 0 for all points");
  request.options.form = choice_in(call, "form", "binary", "binary, ascii or compact",
                                   [](const std::string& text) { return ply_form_named(text); });
  request.options.visible_only = switch_in(call, "visible");
  return request;
}

ApiResponse show_cloud(const Call& call) {
  const CloudRequest request = cloud_request(call);
  const Subject subject = job_subject(call.doors.farm, job_id(call), whole_in(call, "frame")).subject;
  const Made<PlyFile> made = call.doors.diagnostics.cloud(subject, request);
  if (made.standing.state == LayerProgress::failed) throw ApiError(500, made.standing.message);
  if (!made.thing) return in_the_making(made.standing.share_done);
  return {200, "application/octet-stream", *made.thing};
}

constexpr Route routes[]{
    {"GET", "/api/v1/jobs/{id}/statistics?frame&wait", show_statistics, Work::picture},
    {"GET", "/api/v1/jobs/{id}/scene?frame", show_scene, Work::picture},
    {"GET", "/api/v1/jobs/{id}/trace?frame&x&y&sample&story&format&wait", show_trace, Work::trace},
    {"GET", "/api/v1/jobs/{id}/cloud.ply?frame&points&voxel&form&visible&wait", show_cloud, Work::picture},
};

}  // namespace

std::span<const Route> diagnostics_routes() { return routes; }

}  // namespace rayfarm
