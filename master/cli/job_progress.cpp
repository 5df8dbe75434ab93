#include "master/cli/job_progress.h"

#include <nlohmann/json.hpp>

#include "master/cli/text.h"
#include "master/frame_range.h"

namespace rayfarm {
namespace {

std::optional<std::chrono::seconds> eta_of(const nlohmann::json& job) {
  const nlohmann::json& eta = job.at("eta_seconds");
  if (!eta.is_number()) return std::nullopt;
  return std::chrono::seconds(static_cast<long long>(eta.get<double>()));
}

}  // namespace

double fraction_done(const nlohmann::json& job) {
  return job.at("pixels_done").get<double>() / job.at("pixels_total").get<double>();
}

std::string eta_text(const nlohmann::json& job) {
  const auto eta = eta_of(job);
  return eta ? clock_text(*eta) : "";
}

std::string frames_text(const nlohmann::json& job) {
  const nlohmann::json& frames = job.at("frames");
  const FrameRange range{frames.at("first"), frames.at("last"), frames.at("step")};
  return (range.count() == 1 ? "frame " : "frames ") + text_of(range);
}

void show_pause(ProgressLine& line, const nlohmann::json& job) {
  if (job.at("state") != "paused") return line.say("");
  const std::string id = job.at("id").dump(), why = printable(job.at("message"));
  line.say("job " + id + " is paused" + (why.empty() ? "" : ": " + why) + " (rayfarm resume " + id + ")");
}

void show(ProgressLine& line, const nlohmann::json& job) {
  show_pause(line, job);
  const nlohmann::json& frames = job.at("frames");
  std::string details =
      "job " + std::to_string(job.at("id").get<std::uint64_t>()) + " " + job.at("state").get<std::string>();
  if (frames.at("total") > 1)
    details += ", " + frames.at("done").dump() + "/" + frames.at("total").dump() + " frames";
  line.show(fraction_done(job), details, eta_of(job));
}

}  // namespace rayfarm
