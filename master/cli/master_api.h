// The master as the commands see it: JSON in, JSON out, every failure an exit code and a message. A master that has
// answered and is away is waited for, a minute at most, where a question may be asked twice: all but post_json().
#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace rayfarm {

/// RAYFARM_MASTER, or this PC's.
std::string master_url();

nlohmann::json get_json(const std::string& target);
std::string get_bytes(const std::string& target);
/// The bytes at the target, when they have been made; how far they are (0 to 1) is told meanwhile.
std::string get_made(const std::string& target, const std::function<void(double share)>& progress);
/// How far it is now, or within a second.
struct Progress {
  std::optional<std::string> bytes;  // when they have been made
  double share = 0;                  // until then, 0 to 1
};
Progress made_so_far(const std::string& target);
nlohmann::json post_json(const std::string& target, const nlohmann::json& body);
/// What may be posted twice, again and again while the master is too busy or too full; while_busy() is called between.
nlohmann::json post_json_patiently(const std::string& target, const nlohmann::json& body,
                                   const std::function<void()>& while_busy);

using JobNumber = std::uint64_t;
std::string job_target(JobNumber id);

/// Shows the job to news() whenever something changed, until it has ended; the job as it ended. A busy
/// master is asked again. Interrupted, it says that the job goes on.
nlohmann::json await_end(JobNumber id, const std::function<void(const nlohmann::json& job)>& news);
bool has_ended(const nlohmann::json& job);
/// Throws CommandError unless the job is done.
void expect_done(const nlohmann::json& job);

}  // namespace rayfarm
