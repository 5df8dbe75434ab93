#include "master/cli/job_diagnostics.h"

#include <charconv>
#include <cstdio>
#include <sstream>

#include "master/cli/exit_code.h"
#include "master/cli/interrupt.h"
#include "master/cli/print_json.h"
#include "master/cli/progress_line.h"
#include "master/cli/statistics_tables.h"
#include "master/cli/text.h"
#include "master/cli/whole_number.h"
#include "master/files/atomic_write.h"
#include "master/http/request_target.h"

namespace rayfarm {
namespace {

using nlohmann::json;

std::string target_of(JobNumber job, const std::string& what, const Query& query) {
  std::string target = job_target(job) + "/" + what;
  char before = '?';
  for (const auto& [name, value] : query)
    if (!value.empty()) target += std::exchange(before, '&') + name + "=" + percent_encoded(value);
  return target;
}

void write_bytes(const std::string& file, const std::string& bytes) {
  write_atomically(file, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

/// Hits and tests, or why they are not there.
std::string detail_text(const json& detail) {
  if (detail["state"] == "done")
    return table_of_tests(detail["tests"]) + "\n" + table_of_hits(detail["hits"]);
  const std::string what = "hits and tests per ray: ";
  if (detail["state"] != "making") return what + printable(detail["message"]) + "\n";
  return what + percent(static_cast<std::uint64_t>(1000 * detail["progress"].get<double>()), 1000) +
         " counted; ask again later, or wait for them with --wait\n";
}

}  // namespace

void add_job_option(CLI::App& command, std::optional<JobNumber>& job) {
  CLI::Option* scene = command.get_option("SCENE");
  scene->required(false);
  const std::vector<CLI::Option*> others = command.get_options([](const CLI::Option* option) {
    return !option->get_required() && option->get_name() != "--help" && option->get_name() != "--frame";
  });
  CLI::Option* option = command.add_option("--job", job, "A job of the farm, instead of a scene")
                            ->type_name("ID")
                            ->check(whole_number());
  for (CLI::Option* other : others) option->excludes(other);
  command.parse_complete_callback([scene, option] {
    if (scene->empty() && option->empty()) throw CLI::RequiredError("SCENE or --job");
  });
}

std::string number_text(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::string made_for_job(JobNumber job, const std::string& what, const Query& query, const char* doing) {
  note_interrupts();
  ProgressLine line;
  try {
    return get_made(target_of(job, what, query),
                    [&](double share) { line.show(share, doing, std::nullopt); });
  } catch (const CommandError& error) {
    if (error.code != ExitCode::interrupted) throw;
    throw CommandError(ExitCode::interrupted, "interrupted; nothing was written");
  }
}

void write_made_for_job(JobNumber job, const std::string& what, const Query& query, const char* doing,
                        const std::string& file) {
  write_bytes(file, made_for_job(job, what, query, doing));
}

void write_partly_made_for_job(JobNumber job, const std::string& what, Query query, const std::string& file) {
  const Progress now = made_so_far(target_of(job, what, query));
  query.emplace_back("partial", "1");
  write_bytes(file, now.bytes ? *now.bytes : get_bytes(target_of(job, what, query)));
  if (!now.bytes)
    throw CommandError(
        ExitCode::partly_done,
        "only " + percent(static_cast<std::uint64_t>(1000 * now.share), 1000) + " of the pixels were there");
}

std::string frame_text(const std::optional<std::uint32_t>& frame) {
  return frame ? std::to_string(*frame) : "";
}

void print_job_statistics(JobNumber job, const std::optional<std::uint32_t>& frame,
                          const StatisticsWishes& wishes) {
  const Query query{{"frame", frame_text(frame)}};
  const auto whole = [&] { return json::parse(made_for_job(job, "statistics", query, "counting")); };
  const json so_far = get_json(target_of(job, "statistics", query));
  const bool waits =
      so_far["detail"]["state"] == "making" && (wishes.whole || has_ended(get_json(job_target(job))));
  if (wishes.as_json) return print_json(waits ? whole() : so_far);
  std::vector<const char*> phases{"waiting", "rendering", "threads"};
  if (so_far["seconds"].contains("wasted")) phases.push_back("wasted");
  std::printf("%s\n\n%s\n%s\n", headline(so_far["pixels"].dump(), so_far["samples_per_pixel"]).c_str(),
              table_of_rays(so_far).c_str(), table_of_times(so_far["seconds"], phases).c_str());
  if (so_far.contains("rays_wasted")) std::printf("%s rays wasted\n\n", so_far["rays_wasted"].dump().c_str());
  std::fflush(stdout);
  std::fputs(detail_text(waits ? whole()["detail"] : so_far["detail"]).c_str(), stdout);
}

void print_job_trace(JobNumber job, const Query& query, bool as_json) {
  if (as_json) return print_json(json::parse(get_bytes(target_of(job, "trace", query))));
  Query as_text = query;
  as_text.emplace_back("format", "text");
  std::istringstream lines(get_bytes(target_of(job, "trace", as_text)));
  for (std::string line; std::getline(lines, line);) std::puts(printable(line).c_str());
}

}  // namespace rayfarm
