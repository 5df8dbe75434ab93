// rayfarm-worker: renders tiles for a master.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <iostream>
#include <thread>

#include "common/daemon/command_line.h"
#include "common/daemon/stop_signals.h"
#include "common/daemon/system.h"
#include "common/net/run_until_end.h"
#include "worker/worker.h"

namespace rayfarm {
namespace {

constexpr auto examples = R"(
Examples:
  rayfarm-worker --master 127.0.0.1                     works for the master on this PC
  rayfarm-worker --master lab1:5411 --threads 4 --insecure
  rayfarm-worker --listen 0.0.0.0:5411 --insecure       waits for a master with --dial NAME=THIS_PC
  rayfarm-worker --config /etc/rayfarm/worker.toml      keys are the options: master = "lab1", threads = 4

Until the farm is encrypted, only addresses on this PC are used unless --insecure is given.
)";

struct Arguments {
  std::string master, listen, name = host_name();
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  bool insecure = false;
};

void declare(CLI::App& app, Arguments& arguments) {
  declare_common_options(app, arguments.insecure, examples);
  auto* way = app.add_option_group("way", "How worker and master meet");
  way->add_option("--master", arguments.master, "Dial the master, and again whenever it is lost")
      ->type_name("HOST[:PORT]");
  way->add_option("--listen", arguments.listen, "Wait to be dialled by the master")
      ->type_name("ADDRESS[:PORT]");
  way->require_option(1);
  app.add_option("--name", arguments.name, "What the master calls this worker")->capture_default_str();
  app.add_option("--threads", arguments.threads, "Threads that render")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
}

WorkerOptions options_of(const Arguments& arguments) {
  WorkerOptions options;
  if (!arguments.master.empty())
    options.way = DialMaster{parse_address(arguments.master, default_farm_port)};
  else
    options.way = AwaitMaster{parse_address(arguments.listen, default_farm_port)};
  options.identity = {arguments.name, cpu_name(), arguments.threads};
  options.security.exposure = arguments.insecure ? Exposure::insecure : Exposure::loopback_only;
  check(options.identity);
  return options;
}

/// Returns after a clean stop; throws what kept the worker from working.
void serve(WorkerOptions options) {
  // Never destroyed: that would wait for a name that is still being looked up, and hold up a clean stop.
  static auto& io = *new asio::io_context;
  Worker worker(io, std::move(options));
  if (const auto address = worker.listening_at())
    std::cout << "rayfarm-worker: listens at " << text_of(*address) << std::endl;
  StopSignals signals(io, [&] {
    notify_stopping();
    worker.stop();
  });
  notify_ready();
  run_until_end(io, worker.run());
}

}  // namespace
}  // namespace rayfarm

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("rayfarm-worker"));
  rayfarm::Arguments arguments;
  CLI::App app("Renders tiles for a rayfarm master, with the threads of this PC.", "rayfarm-worker");
  rayfarm::declare(app, arguments);
  return rayfarm::run_daemon(app, argc, argv, [&] { rayfarm::serve(rayfarm::options_of(arguments)); });
}
