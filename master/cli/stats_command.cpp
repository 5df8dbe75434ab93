// rayfarm stats: what rendering a scene takes, in numbers.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "master/cli/commands.h"
#include "master/cli/interrupt.h"
#include "master/cli/job_diagnostics.h"
#include "master/cli/picture_options.h"
#include "master/cli/print_json.h"
#include "master/cli/progress_line.h"
#include "master/cli/statistics_tables.h"
#include "master/diagnostics/leaf_names.h"
#include "master/diagnostics/statistics.h"
#include "master/http/settings_json.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

struct StatsArguments {
  PictureOptions picture;
  std::optional<JobNumber> job;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  bool json = false, wait = false;
};

struct Phase {
  const char* name;
  double seconds;
};

struct Report {
  RenderSettings settings;
  Statistics statistics;
  std::vector<std::string> names;  // by leaf
  std::vector<Phase> phases;

  double pixels() const { return static_cast<double>(settings.width) * settings.height; }
  double samples_per_pixel() const { return static_cast<double>(statistics.rays.primary) / pixels(); }
};

nlohmann::json to_json(const Report& r) {
  nlohmann::json counters = to_json(r.statistics.rays), mean, seconds, hits = nlohmann::json::array();
  for (const auto& [name, total] : counters.items()) mean[name] = total.get<double>() / r.pixels();
  for (const Phase& phase : r.phases) seconds[phase.name] = phase.seconds;
  for (const std::size_t leaf : leaves_hit(r.statistics))
    hits.push_back({{"leaf", leaf}, {"name", r.names[leaf]}, {"hits", r.statistics.hits[leaf]}});
  return {{"settings", to_json(r.settings)},
          {"counters", counters},
          {"mean_per_pixel", mean},
          {"hits", hits},
          {"leaves", r.names.size()},
          {"samples_per_pixel", r.samples_per_pixel()},
          {"tests", tests_json(r.statistics)},
          {"seconds", seconds}};
}

void print(const Report& r) {
  const nlohmann::json report = to_json(r);
  std::vector<const char*> phases;
  for (const Phase& phase : r.phases) phases.push_back(phase.name);
  const std::string size = std::to_string(r.settings.width) + "x" + std::to_string(r.settings.height);
  std::printf("%s\n\n%s\n%s\n%s\n%s", headline(size, r.samples_per_pixel()).c_str(),
              table_of_rays(report).c_str(), table_of_tests(report["tests"]).c_str(),
              table_of_hits(report["hits"]).c_str(), table_of_times(report["seconds"], phases).c_str());
}

ExitCode stats(const StatsArguments& a) {
  if (a.job) {
    print_job_statistics(*a.job, a.picture.frame, {a.json, a.wait});
    return ExitCode::done;
  }
  note_interrupts();
  Report report;
  auto last = Clock::now();
  const auto end_phase = [&](const char* name) {
    const auto now = Clock::now();
    report.phases.push_back({name, std::chrono::duration<double>(now - last).count()});
    last = now;
  };
  PreparedScene scene = prepare(a.picture);
  report.settings = scene.settings;
  report.names = leaf_names(scene.scene);
  end_phase("script");
  const World world(std::move(scene.scene));
  end_phase("build");
  {
    ProgressLine line;
    auto statistics = statistics_of(world, scene.settings, a.threads, interrupted,
                                    [&](std::uint32_t done, std::uint32_t all) {
                                      line.show(static_cast<double>(done) / all, "counting", std::nullopt);
                                    });
    if (!statistics) throw CommandError(ExitCode::interrupted, "interrupted");
    report.statistics = std::move(*statistics);
  }
  end_phase("render");

  if (a.json)
    print_json(to_json(report));
  else
    print(report);
  return ExitCode::done;
}

}  // namespace

void add_stats_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<StatsArguments>();
  CLI::App* command = app.add_subcommand("stats", "Count the rays of a render, and who was hit how often");
  add_sample_options(*command, arguments->picture);
  command->add_option("--threads", arguments->threads, "Threads to use (default: all of this PC)")
      ->check(CLI::Range(1u, 1024u));
  add_job_option(*command, arguments->job);
  command->add_flag("--json", arguments->json, "Result as JSON");
  command
      ->add_flag("--wait", arguments->wait,
                 "Of a job that still renders: wait until hits and tests per ray are counted too")
      ->needs("--job");
  command->footer("Examples:\n  rayfarm stats scenes/circus.lua --spp 4\n  rayfarm stats --job 7");
  command->callback([arguments, &chosen] { chosen = [arguments] { return stats(*arguments); }; });
}

}  // namespace rayfarm
