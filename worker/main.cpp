// rayfarm-worker: renders tiles for a master.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iostream>
#include <random>
#include <thread>

#include "common/daemon/command_line.h"
#include "common/daemon/stop_signals.h"
#include "common/daemon/system.h"
#include "common/net/run_until_end.h"
#include "worker/join.h"
#include "worker/pairing.h"
#include "worker/worker.h"

namespace rayfarm {
namespace {

constexpr auto examples = R"(
Examples:
  rayfarm-worker --master 127.0.0.1                     works for the master on this PC
  rayfarm-worker join CODE                              once: this PC becomes a worker of the farm that made the code
  rayfarm-worker                                        works for the farm that it has joined
  rayfarm-worker --listen 0.0.0.0:5411                  waits for a master with --dial NAME=THIS_PC
  rayfarm-worker --config /etc/rayfarm/worker.toml      keys are the options: master = "lab1", threads = 4

Whatever leaves this PC is encrypted, with the keys that were made when it joined.
)";

struct Arguments {
  std::string master, listen, name = host_name(), state = default_worker_state(), code;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  Openness openness;
};

/// The command `join`.
CLI::App* declare(CLI::App& app, Arguments& arguments) {
  declare_common_options(app, arguments.openness, examples);
  auto* way = app.add_option_group(
      "way", "How worker and master meet; else it works for the farm that it has joined");
  way->add_option("--master", arguments.master, "Dial the master, and again whenever it is lost")
      ->type_name("HOST[:PORT]");
  way->add_option("--listen", arguments.listen, "Wait to be dialled by the master")
      ->type_name("ADDRESS[:PORT]");
  way->require_option(0, 1);
  app.add_option("--name", arguments.name, "What the master calls this worker")->capture_default_str();
  app.add_option("--threads", arguments.threads, "Threads that render")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_option("--state", arguments.state, "Where the keys are kept that this PC was given when it joined")
      ->type_name("FOLDER")
      ->capture_default_str();
  CLI::App* join = app.add_subcommand("join", "Become a worker of the farm that made the code, once");
  join->add_option("CODE", arguments.code, "From rayfarm token new; - reads it from standard input")
      ->required();
  join->fallthrough();
  return join;
}

std::string first_line_of(std::istream& in) {
  std::string line;
  std::getline(in, line);
  return line;
}

/// Other users of this PC can read what a program was called with.
void hide(const std::string& secret, int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (argv[i] == secret) std::fill_n(argv[i], secret.size(), '*');
}

constexpr int master_unreachable = 3, not_allowed = 4,
              version_refused = 6;  // as the command rayfarm has them

int join_farm(const Arguments& arguments) try {
  const Invitation invitation =
      parse_invitation(arguments.code == "-" ? first_line_of(std::cin) : arguments.code);
  if (arguments.master.empty() && !invitation.master)
    throw std::invalid_argument("the code does not say where the master is: say --master HOST[:PORT]");
  const Address master =
      arguments.master.empty() ? *invitation.master : parse_address(arguments.master, default_farm_port);
  check({arguments.name, cpu_name()});
  if (arguments.name.size() > max_owner_name)
    throw std::invalid_argument("a worker's name has at most " + std::to_string(max_owner_name) + " bytes");
  make_room_for_pairing(arguments.state);
  write_pairing(arguments.state, join(invitation.code, master, arguments.name));
  std::cout << "rayfarm-worker: joined the farm at " << text_of(master) << " as \"" << arguments.name
            << "\"\n";
  return 0;
} catch (const ConnectionLost& error) {
  std::cerr << "rayfarm-worker: " << error.what() << "\n";
  return master_unreachable;
} catch (const JoinRefused& error) {
  std::cerr << "rayfarm-worker: " << error.what() << "\n";
  return not_allowed;
} catch (const VersionRefused& error) {
  std::cerr << "rayfarm-worker: " << error.what() << "\n";
  return version_refused;
}

std::variant<DialMaster, AwaitMaster> way_of(const Arguments& arguments,
                                             const std::optional<Pairing>& pairing) {
  if (!arguments.listen.empty()) return AwaitMaster{parse_address(arguments.listen, default_farm_port)};
  if (!arguments.master.empty()) return DialMaster{parse_address(arguments.master, default_farm_port)};
  if (pairing) return DialMaster{pairing->master};
  throw std::invalid_argument("this PC has not joined a farm (" + arguments.state +
                              "): rayfarm-worker join CODE, or say --master HOST or --listen ADDRESS");
}

/// The farm that was joined is always talked to with the keys that it gave; an address that is named on this PC may be
/// another farm's.
Security security_of(const Arguments& arguments, const std::optional<Pairing>& pairing) {
  const bool is_named = !arguments.master.empty() || !arguments.listen.empty();
  const bool is_closed = arguments.openness.closed || !is_named;
  Security security{arguments.openness.insecure ? Exposure::insecure
                    : is_closed                 ? Exposure::closed
                                                : Exposure::loopback_only};
  if (pairing) security.tls.emplace(pairing->own, pairing->authority, PeerRole::master);
  return security;
}

WorkerOptions options_of(const Arguments& arguments) {
  const std::optional<Pairing> pairing = read_pairing(arguments.state);
  WorkerOptions options;
  options.way = way_of(arguments, pairing);
  std::random_device chance;
  options.identity = {arguments.name, cpu_name(), arguments.threads,
                      std::uint64_t{chance()} << 32 | chance()};
  options.security = security_of(arguments, pairing);
  check(options.identity);
  return options;
}

/// Returns after a clean stop; throws what kept the worker from working.
int serve(WorkerOptions options) {
  // Never destroyed: that would wait for a name that is still being looked up, and hold up a clean stop.
  static auto& io = *new asio::io_context;
  WorkerDaemon worker(io, std::move(options));
  if (const auto address = worker.listening_at())
    std::cout << "rayfarm-worker: listens at " << text_of(*address) << std::endl;
  StopSignals signals(io, [&] {
    notify_stopping();
    worker.stop();
  });
  notify_ready();
  run_until_end(io, worker.run());
  return 0;
}

}  // namespace
}  // namespace rayfarm

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("rayfarm-worker"));
  rayfarm::Arguments arguments;
  CLI::App app("Renders tiles for a rayfarm master, with the threads of this PC.", "rayfarm-worker");
  const CLI::App* join = rayfarm::declare(app, arguments);
  return rayfarm::run_daemon(app, argc, argv, [&] {
    if (!arguments.code.empty()) rayfarm::hide(arguments.code, argc, argv);
    return join->parsed() ? rayfarm::join_farm(arguments) : rayfarm::serve(rayfarm::options_of(arguments));
  });
}
