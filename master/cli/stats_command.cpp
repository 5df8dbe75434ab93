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
#include "master/cli/text.h"
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
  bool json = false;
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

using Table = std::vector<std::vector<std::string>>;

std::string thousandths(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", number);
  return text;
}

Table table_of_rays(const Report& r) {
  const RayCounters& c = r.statistics.rays;
  Table rays{{"RAYS", "TOTAL", "PER PIXEL"}};
  const auto row = [&](const char* name, std::uint64_t total) {
    rays.push_back({name, std::to_string(total), thousandths(static_cast<double>(total) / r.pixels())});
  };
  row("primary", c.primary), row("reflected", c.reflected), row("refracted", c.refracted);
  row("shadow", c.shadow), row("all", c.rays());
  row("hits", c.primary_hits + c.secondary_hits), row("misses", c.misses());
  row("lost rays", c.lost), row("bad samples", c.bad_samples);
  return rays;
}

Table table_of_tests(const Report& r) {
  Table tests{{"PER RAY", "BOXES TESTED", "SOLIDS TESTED", "CROSSINGS FOUND"}};
  const nlohmann::json kinds = tests_json(r.statistics);
  for (const char* kind : {"nearest", "shadow"}) {
    std::vector<std::string> row{kind};
    for (const char* mean : {"boxes_per_ray", "leaves_per_ray", "crossings_per_ray"})
      row.push_back(thousandths(kinds.at(kind).at(mean)));
    tests.push_back(row);
  }
  return tests;
}

void print(const Report& r) {
  const RayCounters& c = r.statistics.rays;
  Table hits{{"SOLID", "HITS", "SHARE"}};
  for (const std::size_t leaf : leaves_hit(r.statistics))
    hits.push_back({printable(r.names[leaf]), std::to_string(r.statistics.hits[leaf]),
                    share(r.statistics.hits[leaf], c.primary_hits + c.secondary_hits)});

  Table times{{"PHASE", "SECONDS"}};
  for (const Phase& phase : r.phases) times.push_back({phase.name, thousandths(phase.seconds)});

  std::printf("%ux%u pixels, %s samples per pixel\n\n%s\n%s\n%s\n%s", r.settings.width, r.settings.height,
              thousandths(r.samples_per_pixel()).c_str(), table(table_of_rays(r)).c_str(),
              table(table_of_tests(r)).c_str(), table(hits).c_str(), table(times).c_str());
}

ExitCode stats(const StatsArguments& a) {
  if (a.job) {
    print_job_statistics(*a.job, a.picture.frame, a.json);
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
  command->footer("Examples:\n  rayfarm stats scenes/circus.lua --spp 4\n  rayfarm stats --job 7");
  command->callback([arguments, &chosen] { chosen = [arguments] { return stats(*arguments); }; });
}

}  // namespace rayfarm
