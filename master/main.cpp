// rayfarm-master: the farm, its doors, and threads of its own.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <asio/post.hpp>
#include <iostream>
#include <optional>
#include <set>
#include <thread>

#include "common/daemon/command_line.h"
#include "common/daemon/stop_signals.h"
#include "common/daemon/system.h"
#include "common/net/run_until_end.h"
#include "master/diagnostics/diagnostics.h"
#include "master/http/server.h"
#include "master/local_threads.h"
#include "master/sessions.h"
#include "master/state_folder.h"

namespace rayfarm {
namespace {

constexpr auto examples = R"(
Examples:
  rayfarm-master                                        renders with this PC's threads; page at http://127.0.0.1:5412
  rayfarm-master --listen 0.0.0.0:5411 --insecure       takes in workers from other PCs
  rayfarm-master --dial lab1=192.168.1.11 --dial lab2=192.168.1.12 --insecure
  rayfarm-master --config /etc/rayfarm/master.toml      keys are the options: threads = 0, dial = ["lab1=192.168.1.11"]

Until the farm is encrypted, only addresses on this PC are used unless --insecure is given.
)";

struct Arguments {
  std::string state, listen = "127.0.0.1:5411", http = "127.0.0.1:5412";
  std::vector<std::string> dial;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  bool insecure = false;
};

void expect_distinct_names(const std::vector<std::string>& targets) {
  std::set<std::string> names;
  for (const std::string& target : targets)
    if (const std::string name = target.substr(0, target.find('=')); !names.insert(name).second)
      throw CLI::ValidationError("--dial", "two workers are named " + name + "; give each a name of its own");
}

void declare(CLI::App& app, Arguments& arguments) {
  declare_common_options(app, arguments.insecure, examples);
  app.add_option("--state", arguments.state,
                 "A folder for this master alone; jobs do not outlive a master yet")
      ->type_name("FOLDER");
  app.add_option("--listen", arguments.listen, "Where workers come; port 0: any free one")
      ->type_name("ADDRESS[:PORT]")
      ->capture_default_str();
  app.add_option("--http", arguments.http, "Where the command and the browser come")
      ->type_name("ADDRESS:PORT")
      ->capture_default_str();
  app.add_option("--threads", arguments.threads, "Threads of its own that render; 0: none")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_option("--dial", arguments.dial, "A worker that waits with --listen; may be repeated")
      ->type_name("NAME=HOST[:PORT]")
      ->allow_extra_args(false);
  app.final_callback([&arguments] { expect_distinct_names(arguments.dial); });
}

/// A bad one is named; the others are dialled.
void dial_all(Sessions& sessions, const std::vector<std::string>& targets) {
  for (const std::string& target : targets) try {
      sessions.dial(parse_dial_target(target));
    } catch (const AddressError& error) {
      spdlog::error("--dial: {}", error.what());
    }
}

/// Returns after a clean stop; throws what kept the master from starting.
void serve(const Arguments& arguments) {
  allow_many_descriptors();
  std::optional<StateFolder> state;
  if (!arguments.state.empty()) state.emplace(arguments.state);

  // Never destroyed: that would wait for names that are still being looked up, and hold up a clean stop.
  static auto& io = *new asio::io_context;
  LiveFarm farm;
  Sessions sessions(io, farm, parse_address(arguments.listen, default_farm_port),
                    Security{arguments.insecure ? Exposure::insecure : Exposure::loopback_only});
  FarmDoor door([&](std::function<void(Farm&, FarmTime)> question) {
    asio::post(io, [&farm, question = std::move(question)] { farm.apply(question); });
  });
  FrameFeeder feeder(door);
  Diagnostics diagnostics(std::max(1u, std::thread::hardware_concurrency()));
  const MasterDoor master{
      [&](const std::string& target) { sessions.dial(parse_dial_target(target)); },
      [&] { return sessions.dialling(); },
      [&](std::uint64_t after) { return farm.log().after(after); },
      [&](const std::string& name) { return sessions.stop_dialling(name); },
  };
  const AppFiles app;
  const SceneLibrary scenes;
  AssetStore assets;
  const HttpServer http({arguments.http, arguments.insecure}, {.farm = door,
                                                               .feeder = feeder,
                                                               .diagnostics = diagnostics,
                                                               .master = master,
                                                               .app = app,
                                                               .scenes = scenes,
                                                               .assets = assets});
  std::optional<LocalThreads> local;
  if (arguments.threads > 0) local.emplace(io, farm, arguments.threads);
  dial_all(sessions, arguments.dial);

  StopSignals signals(io, [&] {
    spdlog::info("stopping");
    notify_stopping();
    diagnostics.stop();
    sessions.stop();
  });
  std::cout << "rayfarm-master: workers " << text_of(sessions.listening_at()) << ", http " << http.url()
            << std::endl;
  notify_ready();
  run_until_end(io, sessions.run());
}

}  // namespace
}  // namespace rayfarm

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("rayfarm-master"));
  rayfarm::Arguments arguments;
  CLI::App app("Shares pictures out among workers and this PC's own threads.", "rayfarm-master");
  rayfarm::declare(app, arguments);
  return rayfarm::run_daemon(app, argc, argv, [&] { rayfarm::serve(arguments); });
}
