#include "master/cli/job_progress.h"

#include <nlohmann/json.hpp>

#include "master/cli/text.h"

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

void show(ProgressLine& line, const nlohmann::json& job) {
  const std::string details =
      "job " + std::to_string(job.at("id").get<std::uint64_t>()) + " " + job.at("state").get<std::string>();
  line.show(fraction_done(job), details, eta_of(job));
}

}  // namespace rayfarm
