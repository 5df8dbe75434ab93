// rayfarm workers, drain, undrain, ban, unban.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "master/cli/commands.h"
#include "master/cli/master_api.h"
#include "master/cli/print_json.h"
#include "master/cli/text.h"
#include "master/http/request_target.h"

namespace rayfarm {
namespace {

using nlohmann::json;

struct WorkerArguments {
  std::string name;
  bool json = false;
};

ExitCode list_workers(const WorkerArguments& a) {
  const json answer = get_json("/api/v1/workers");
  if (a.json) {
    print_json(answer);
    return ExitCode::done;
  }
  std::vector<std::vector<std::string>> rows{
      {"NAME", "STATE", "THREADS", "HOLDS", "TILES", "SAMPLES/S", "ADDRESS", "CPU", "NOTE"}};
  for (const json& worker : answer.at("workers")) {
    const double speed = worker.at("samples_per_second");
    rows.push_back({printable(worker.at("name")), worker.at("state"), worker.at("threads").dump(),
                    worker.at("leases").dump(), worker.at("tiles").dump(),
                    speed > 0 ? short_count(speed) : "", printable(worker.at("address")),
                    printable(worker.at("cpu")), printable(worker.at("message"))});
  }
  std::fputs(table(rows).c_str(), stdout);
  return ExitCode::done;
}

ExitCode change_worker(const WorkerArguments& a, const std::string& verb) {
  const json answer = post_json("/api/v1/workers/" + percent_encoded(a.name) + "/" + verb, json::object());
  if (a.json)
    print_json(answer);
  else
    std::printf("%s: %s\n", verb.c_str(), a.name.c_str());
  return ExitCode::done;
}

}  // namespace

void add_worker_commands(CLI::App& app, Command& chosen) {
  const auto all = std::make_shared<WorkerArguments>();
  CLI::App* list = app.add_subcommand("workers", "List all workers");
  list->add_flag("--json", all->json, "Answer as JSON");
  list->callback([=, &chosen] { chosen = [=] { return list_workers(*all); }; });

  for (const auto& [verb, help] :
       {std::pair{"drain", "Give a worker nothing more; others take what it holds"},
        std::pair{"undrain", "Let a drained worker work again"},
        std::pair{"ban", "End a worker's connection and refuse it from now on"},
        std::pair{"unban", "Let a banned worker come again"}}) {
    const auto one = std::make_shared<WorkerArguments>();
    CLI::App* command = app.add_subcommand(verb, help);
    command->add_option("NAME", one->name, "The worker's name, as workers shows it")->required();
    command->add_flag("--json", one->json, "Answer as JSON");
    command->callback(
        [=, &chosen, verb = std::string(verb)] { chosen = [=] { return change_worker(*one, verb); }; });
  }
}

}  // namespace rayfarm
