// rayfarm jobs, job, watch, pause, resume, cancel, remove, priority.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "master/cli/commands.h"
#include "master/cli/interrupt.h"
#include "master/cli/job_progress.h"
#include "master/cli/master_api.h"
#include "master/cli/print_json.h"
#include "master/cli/text.h"
#include "master/cli/whole_number.h"

namespace rayfarm {
namespace {

using nlohmann::json;

struct JobArguments {
  JobNumber id = 0;
  int priority = 0;
  bool json = false;
};

std::string text_in(const json& object, const char* name) {
  return printable(object.at(name).get<std::string>());
}
std::string number_in(const json& object, const char* name) { return object.at(name).dump(); }

std::string size_text(const json& settings) {
  return number_in(settings, "width") + "x" + number_in(settings, "height");
}

std::string progress_of(const json& job) { return percent(job.at("pixels_done"), job.at("pixels_total")); }

/// 12/500; of a still nothing.
std::string frames_done(const json& job) {
  const json& frames = job.at("frames");
  return frames.at("total") == 1 ? "" : number_in(frames, "done") + "/" + number_in(frames, "total");
}

/// 37/500 while scenes are still to come from whoever submitted it.
std::string frames_known(const json& job) {
  const json& frames = job.at("frames");
  return frames.at("sent") == frames.at("total")
             ? ""
             : number_in(frames, "sent") + "/" + number_in(frames, "total");
}

ExitCode list_jobs(const JobArguments& a) {
  const json answer = get_json("/api/v1/jobs");
  if (a.json) {
    print_json(answer);
    return ExitCode::done;
  }
  std::vector<std::vector<std::string>> rows{
      {"ID", "NAME", "STATE", "DONE", "FRAMES", "ETA", "PRIORITY", "SIZE", "SPP", "OUTPUT"}};
  for (const json& job : answer.at("jobs")) {
    const json& settings = job.at("settings");
    rows.push_back({number_in(job, "id"), text_in(job, "name"), text_in(job, "state"), progress_of(job),
                    frames_done(job), eta_text(job), number_in(job, "priority"), size_text(settings),
                    number_in(settings, "spp"), text_in(job, "output")});
  }
  std::fputs(table(rows).c_str(), stdout);
  return ExitCode::done;
}

/// Empty when nothing is to be verified.
std::string verified_text(const json& job) {
  const std::string verify = text_in(job, "verify");
  return verify == "none" ? "" : verify + ", " + number_in(job, "tiles_checked") + " tiles checked";
}

ExitCode show_job(const JobArguments& a) {
  const json job = get_json(job_target(a.id));
  if (a.json) {
    print_json(job);
    return ExitCode::done;
  }
  const json &settings = job.at("settings"), &counters = job.at("counters");
  const std::chrono::seconds elapsed(static_cast<long long>(job.at("elapsed_seconds").get<double>()));
  const std::chrono::seconds wasted(static_cast<long long>(job.at("seconds_wasted").get<double>()));
  std::vector<std::vector<std::string>> rows{
      {"id", number_in(job, "id")},
      {"name", text_in(job, "name")},
      {"state", text_in(job, "state")},
      {"done", progress_of(job)},
      {"elapsed", clock_text(elapsed)},
      {"ETA", eta_text(job)},
      {"priority", number_in(job, "priority")},
      {"size", size_text(settings)},
      {"samples per pixel", number_in(settings, "spp")},
      {"sampler", text_in(settings, "sampler")},
      {"seed", number_in(settings, "seed")},
      {"frames", frames_text(job).substr(frames_text(job).find(' ') + 1)},
      {"frames done", frames_done(job)},
      {"frames known", frames_known(job)},
      {"rays", short_count(counters.at("rays").get<double>())},
      {"bad samples", number_in(counters, "bad_samples")},
      {"lost rays", number_in(counters, "lost")},
      {"tiles given back", number_in(job, "tiles_given_back")},
      {"tiles rendered twice", number_in(job, "tiles_doubled")},
      {"tiles shared", number_in(job, "tiles_shared")},
      {"verified", verified_text(job)},
      {"thread time wasted", clock_text(wasted)},
      {"rays wasted", short_count(job.at("rays_wasted").get<double>())},
      {"output", text_in(job, "output")},
      {"scene", text_in(job, "scene_hash")},
      {"message", text_in(job, "message")},
  };
  std::erase_if(rows, [](const std::vector<std::string>& row) { return row[1].empty(); });
  std::fputs(table(rows).c_str(), stdout);
  return ExitCode::done;
}

ExitCode watch_job(const JobArguments& a) {
  note_interrupts();
  json ended;
  if (a.json) {
    ended = await_end(a.id, print_json);
  } else {
    ProgressLine line;
    ended = await_end(a.id, [&](const json& job) { show(line, job); });
  }
  expect_done(ended);
  if (!a.json) std::printf("job %llu is done\n", static_cast<unsigned long long>(a.id));
  return ExitCode::done;
}

/// POSTs the verb and says what the job is now.
ExitCode change_job(const JobArguments& a, const std::string& verb, const json& body) {
  const json job = post_json(job_target(a.id) + "/" + verb, body);
  if (a.json)
    print_json(job);
  else
    std::printf("job %llu is %s, priority %s\n", static_cast<unsigned long long>(a.id),
                text_in(job, "state").c_str(), number_in(job, "priority").c_str());
  return ExitCode::done;
}

ExitCode remove_job(const JobArguments& a) {
  const json job = post_json(job_target(a.id) + "/remove", json::object());
  if (a.json)
    print_json(job);
  else
    std::printf("job %llu, which was %s, is removed\n", static_cast<unsigned long long>(a.id),
                text_in(job, "state").c_str());
  return ExitCode::done;
}

using Run = std::function<ExitCode(const JobArguments&)>;
using Arguments = std::shared_ptr<JobArguments>;

/// A command with --json that fills the arguments and runs with them.
CLI::App* add(CLI::App& app, Command& chosen, const std::string& name, const std::string& help,
              const Arguments& arguments, const Run& run) {
  CLI::App* command = app.add_subcommand(name, help);
  command->add_flag("--json", arguments->json, "Answer as JSON");
  command->callback([=, &chosen] { chosen = [=] { return run(*arguments); }; });
  return command;
}

/// One about a single job.
CLI::App* add_for_job(CLI::App& app, Command& chosen, const std::string& name, const std::string& help,
                      const Arguments& arguments, const Run& run) {
  CLI::App* command = add(app, chosen, name, help, arguments, run);
  command->add_option("ID", arguments->id, "The job's number, as submit and jobs show it")
      ->required()
      ->check(whole_number());
  return command;
}

void add_verb(CLI::App& app, Command& chosen, const std::string& verb, const std::string& help) {
  add_for_job(app, chosen, verb, help, std::make_shared<JobArguments>(),
              [verb](const JobArguments& a) { return change_job(a, verb, json::object()); });
}

}  // namespace

void add_job_commands(CLI::App& app, Command& chosen) {
  const auto fresh = [] { return std::make_shared<JobArguments>(); };
  add(app, chosen, "jobs", "List all jobs", fresh(), list_jobs);
  add_for_job(app, chosen, "job", "Show all about a job", fresh(), show_job);
  add_for_job(app, chosen, "watch", "Show a job's progress until it has ended", fresh(), watch_job);
  add_verb(app, chosen, "pause", "Stop work on a job until it is resumed");
  add_verb(app, chosen, "resume", "Go on with a paused or held job");
  add_verb(app, chosen, "cancel", "End a job for good; what is rendered can still be fetched");
  add_for_job(app, chosen, "remove", "Forget a job that has ended, with its pictures", fresh(), remove_job);

  const Arguments arguments = fresh();
  add_for_job(app, chosen, "priority", "Change a job's priority", arguments,
              [](const JobArguments& a) {
                return change_job(a, "priority", {{"priority", a.priority}});
              })
      ->add_option("N", arguments->priority, "0 to 99, higher first")
      ->required()
      ->check(CLI::Range(0, 99));
}

}  // namespace rayfarm
