// rayfarm submit: the script is evaluated here, the scene goes to the farm.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "master/cli/commands.h"
#include "master/cli/interrupt.h"
#include "master/cli/job_picture.h"
#include "master/cli/job_progress.h"
#include "master/cli/master_api.h"
#include "master/cli/picture_options.h"
#include "master/cli/print_json.h"
#include "master/http/submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

struct SubmitArguments {
  PictureOptions picture;
  std::string name, key;
  int priority = 50;
  bool hold = false, watch = false, wait = false, json = false;
};

JobSpec spec_of(const SubmitArguments& a, PreparedScene scene) {
  if (scene.bytes.size() > largest_scene)
    throw CommandError(ExitCode::usage, "the scene takes " + std::to_string(scene.bytes.size() >> 20) +
                                            " MB; at most " + std::to_string(largest_scene >> 20) +
                                            " can be submitted");
  JobSpec spec;
  spec.name = a.name.empty() ? std::filesystem::path(a.picture.scene_file).stem().string() : a.name;
  spec.output = a.picture.output;
  spec.scene_hash = scene.hash;
  spec.scene_bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(scene.bytes));
  spec.settings = scene.settings;
  spec.priority = a.priority;
  spec.hold = a.hold;
  spec.key = a.key;
  return spec;
}

json watched(JobNumber id) {
  ProgressLine line;
  return await_end(id, [&](const json& job) { show(line, job); });
}

ExitCode submit(const SubmitArguments& a) {
  check_writable(a.picture.output);
  note_interrupts();
  const json submitted = post_json("/api/v1/jobs", to_json(spec_of(a, prepare(a.picture))));
  const JobNumber id = submitted.at("id");
  const bool stays = a.watch || a.wait;
  if (!a.json) print_json(id);
  if (a.json && !stays) print_json(submitted);
  if (!stays) return ExitCode::done;

  const json ended = a.watch ? watched(id) : await_end(id, [](const json&) {});
  if (a.json) print_json(ended);
  expect_done(ended);
  write_job_picture(a.picture.output, ended, fetch_film(ended), a.picture.curve());
  if (!a.json) std::fprintf(stderr, "lost rays: %llu\n", ended.at("counters").at("lost").get<unsigned long long>());
  return ExitCode::done;
}

}  // namespace

void add_submit_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<SubmitArguments>();
  SubmitArguments& a = *arguments;
  CLI::App* command = app.add_subcommand("submit", "Send a scene to the farm; prints the job's id");
  add_picture_options(*command, a.picture);
  command->add_option("--name", a.name, "Name of the job (default: the script's)");
  command->add_option("--priority", a.priority, "0 to 99, higher first (default 50)")
      ->check(CLI::Range(0, 99));
  command->add_flag("--hold", a.hold, "Start paused");
  command->add_option("--id", a.key, "A key of your own: the same key gives the same job again");
  CLI::Option* watch = command->add_flag("--watch", a.watch, "Show the progress, then write the picture");
  command->add_flag("--wait", a.wait, "Wait in silence, then write the picture")->excludes(watch);
  command->add_flag("--json", a.json, "The job as JSON");
  command->footer(
      "Example: rayfarm submit scenes/sphere_flake.lua -p depth=5 -o flake.exr --watch\n"
      "The master is the one that RAYFARM_MASTER names, by default http://127.0.0.1:5412.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return submit(*arguments); }; });
}

}  // namespace rayfarm
