#include "master/cli/job_diagnostics.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <sstream>

#include "master/cli/exit_code.h"
#include "master/cli/interrupt.h"
#include "master/cli/print_json.h"
#include "master/cli/progress_line.h"
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

std::string fixed(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", number);
  return text;
}

using Rows = std::vector<std::vector<std::string>>;

Rows ray_rows(const json& statistics) {
  Rows rows{{"COUNT", "TOTAL", "PER PIXEL"}};
  for (const auto& [name, total] : statistics["counters"].items()) {
    std::string words = printable(name);
    std::ranges::replace(words, '_', ' ');
    rows.push_back({words, total.dump(), fixed(statistics["mean_per_pixel"][name])});
  }
  return rows;
}

Rows hit_rows(const json& hits) {
  std::uint64_t all = 0;
  for (const json& leaf : hits) all += leaf["hits"].get<std::uint64_t>();
  Rows rows{{"SOLID", "HITS", "SHARE"}};
  for (const json& leaf : hits)
    rows.push_back({printable(leaf["name"]), leaf["hits"].dump(), share(leaf["hits"], all)});
  return rows;
}

Rows time_rows(const json& seconds) {
  Rows rows{{"PHASE", "SECONDS"}};
  for (const char* phase : {"waiting", "rendering", "threads"})
    rows.push_back({phase, fixed(seconds[phase])});
  return rows;
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
  const std::string bytes = made_for_job(job, what, query, doing);
  write_atomically(file, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

std::string frame_text(const std::optional<std::uint32_t>& frame) {
  return frame ? std::to_string(*frame) : "";
}

void print_job_statistics(JobNumber job, const std::optional<std::uint32_t>& frame, bool as_json) {
  const json statistics =
      json::parse(made_for_job(job, "statistics", {{"frame", frame_text(frame)}}, "counting"));
  if (as_json) return print_json(statistics);
  const json& detail = statistics["detail"];
  const std::string hits = detail["state"] == "done" ? table(hit_rows(detail["hits"]))
                                                     : "hits: " + printable(detail["message"]) + "\n";
  std::printf("%s pixels\n\n%s\n%s\n%s", statistics["pixels"].dump().c_str(),
              table(ray_rows(statistics)).c_str(), hits.c_str(),
              table(time_rows(statistics["seconds"])).c_str());
}

void print_job_trace(JobNumber job, const Query& query, bool as_json) {
  if (as_json) return print_json(json::parse(made_for_job(job, "trace", query, "tracing")));
  Query as_text = query;
  as_text.emplace_back("format", "text");
  std::istringstream lines(made_for_job(job, "trace", as_text, "tracing"));
  for (std::string line; std::getline(lines, line);) std::puts(printable(line).c_str());
}

}  // namespace rayfarm
