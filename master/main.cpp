// rayfarm-master: the farm, its doors, and threads of its own.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <asio/post.hpp>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "common/daemon/command_line.h"
#include "common/daemon/stop_signals.h"
#include "common/daemon/system.h"
#include "common/net/run_until_end.h"
#include "common/net/stranger_log.h"
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
  rayfarm-master --state ~/farm --listen 0.0.0.0:5411   takes in workers from other PCs: rayfarm token new
  rayfarm-master --state ~/farm --dial lab1=192.168.1.11 --dial lab2=192.168.1.12
  rayfarm-master --state ~/farm --keep-days 30          forgets jobs a month after their end
  rayfarm-master --config /etc/rayfarm/master.toml      keys are the options: threads = 0, dial = ["lab1=192.168.1.11"]

Whatever leaves this PC is encrypted, with keys that are made in the state folder at the first start.
)";

/// What of jobs that have ended is kept.
struct Keeping {
  std::size_t jobs = FarmLimits{}.jobs;
  std::optional<std::int64_t> days;
  std::uint64_t gigabytes = FarmLimits{}.film_bytes >> 30;

  FarmLimits limits() const {
    FarmLimits limits;
    limits.jobs = jobs, limits.film_bytes = gigabytes << 30;
    if (days) limits.job_age = std::chrono::days(*days);
    return limits;
  }
};

struct Arguments {
  std::string state, listen = "127.0.0.1:5411", http = "127.0.0.1:5412";
  std::string certificate, key;
  std::vector<std::string> dial;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  Keeping keep;
  Openness openness;
};

void expect_distinct_names(const std::vector<std::string>& targets) {
  std::set<std::string> names;
  for (const std::string& target : targets)
    if (const std::string name = target.substr(0, target.find('=')); !names.insert(name).second)
      throw CLI::ValidationError("--dial", "two workers are named " + name + "; give each a name of its own");
}

void declare_keeping(CLI::App& app, Keeping& keep) {
  app.add_option("--keep-jobs", keep.jobs, "So many jobs that have ended are kept, those that ended last")
      ->type_name("N")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--keep-days", keep.days,
                 "And for so many days after their end; without it as long as there is room")
      ->type_name("D")
      ->check(CLI::Range(1, 36'500));
  app.add_option("--keep-gb", keep.gigabytes,
                 "Of their pictures and scenes so many GB, the newest; in memory, and in the state folder")
      ->type_name("GB")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
}

void declare(CLI::App& app, Arguments& arguments) {
  declare_common_options(app, arguments.openness, examples);
  app.add_option("--state", arguments.state,
                 "A folder for this master alone: its keys, who it lets in, jobs and pictures; they outlive "
                 "the master")
      ->type_name("FOLDER")
      ->check([](const std::string& folder) {
        return std::string(folder.empty() ? "the name of a folder, which must not be empty" : "");
      });
  app.add_option("--listen", arguments.listen, "Where workers come; port 0: any free one")
      ->type_name("ADDRESS[:PORT]")
      ->capture_default_str();
  app.add_option("--http", arguments.http, "Where the command and the browser come")
      ->type_name("ADDRESS:PORT")
      ->capture_default_str();
  CLI::Option* certificate = app.add_option("--cert", arguments.certificate,
                                            "For browsers: another certificate than the farm's own, as PEM")
                                 ->type_name("FILE");
  CLI::Option* key =
      app.add_option("--key", arguments.key, "Its private key")->type_name("FILE")->needs(certificate);
  certificate->needs(key);
  app.add_option("--threads", arguments.threads, "Threads of its own that render; 0: none")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_option("--dial", arguments.dial, "A worker that waits with --listen; may be repeated")
      ->type_name("NAME=HOST[:PORT]")
      ->allow_extra_args(false);
  declare_keeping(app, arguments.keep);
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

/// The folder of a master, and what it keeps there.
struct State {
  explicit State(const std::string& path)
      : folder(path), access(path, own_hosts(), std::chrono::system_clock::now()) {}
  StateFolder folder;
  Access access;
};

Exposure exposure_of(const Openness& openness) {
  return openness.insecure ? Exposure::insecure
         : openness.closed ? Exposure::closed
                           : Exposure::loopback_only;
}

Security security_of(const Openness& openness, const State* state) {
  Security security{exposure_of(openness)};
  if (state) security.tls.emplace(state->access.identity(), state->access.authority(), PeerRole::worker);
  return security;
}

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file);
  return {std::istreambuf_iterator<char>(in), {}};
}

Identity identity_in(const std::string& certificate_file, const std::string& key_file) try {
  Identity identity{content_of(key_file), content_of(certificate_file)};
  if (!is_of_key(identity.certificate, identity.key))
    throw CertificateError("the key is another certificate's");
  return identity;
} catch (const CertificateError& error) {
  throw std::runtime_error("--cert " + certificate_file + " with --key " + key_file +
                           " cannot be used: " + error.what());
}

/// What browsers are shown; behind the farm's own certificate its authority, which they may have been told to trust.
std::optional<Identity> web_identity(const Arguments& arguments, const Access* access) {
  if (!arguments.certificate.empty()) return identity_in(arguments.certificate, arguments.key);
  if (!access) return std::nullopt;
  return Identity{access->identity().key, access->identity().certificate + access->authority()};
}

/// As other PCs see it.
std::string farm_address(const Address& listening) {
  const bool is_any = listening.host == "0.0.0.0" || listening.host == "::";
  return text_of(Address{is_any ? outward_address() : listening.host, listening.port});
}

/// Returns after a clean stop; throws what kept the master from starting.
int serve(const Arguments& arguments) {
  allow_many_descriptors();
  std::optional<State> state;
  if (!arguments.state.empty()) state.emplace(arguments.state);
  Access* const access = state ? &state->access : nullptr;

  // Never destroyed: that would wait for names that are still being looked up, and hold up a clean stop.
  static auto& io = *new asio::io_context;
  LiveFarm farm(arguments.keep.limits());
  Sessions sessions(io, farm, parse_address(arguments.listen, default_farm_port),
                    security_of(arguments.openness, state ? &*state : nullptr), {}, access);
  FarmDoor door(
      [&](std::function<void(Farm&, FarmTime)> question) {
        asio::post(io, [&farm, question = std::move(question)] {
          farm.keep();  // so that the asker hears of no fault but its own
          farm.apply(question);
          farm.keep();
        });
      },
      [&](Told told) { farm.once_kept(std::move(told)); }, [&] { return farm.until_synced(); });
  FrameFeeder feeder(door);
  Diagnostics diagnostics(std::max(1u, std::thread::hardware_concurrency()));
  StrangerLog people_refused;
  const MasterDoor master{
      [&](const std::string& target) { sessions.dial(parse_dial_target(target)); },
      [&] { return sessions.dialling(); },
      [&](std::uint64_t after) { return farm.log().after(after); },
      [&](const std::string& name) { return sessions.stop_dialling(name); },
      [&](const std::set<std::string>& certificates) { sessions.cut_off(certificates); },
      [&](const std::string& line) {
        asio::post(io, [&people_refused, line] {
          const auto told = people_refused.line_for(line, std::chrono::steady_clock::now());
          if (told) spdlog::warn("{}", *told);  // not for viewers
        });
      },
      farm_address(sessions.listening_at()),
      [](const std::string& line) { spdlog::info("{}", line); },
  };
  const AppFiles app;
  const SceneLibrary scenes;
  AssetStore assets;
  const HttpSettings http_settings{.listen = arguments.http,
                                   .exposure = exposure_of(arguments.openness),
                                   .identity = web_identity(arguments, access),
                                   .outward_host = outward_address()};
  const HttpServer http(http_settings, {.farm = door,
                                        .feeder = feeder,
                                        .diagnostics = diagnostics,
                                        .master = master,
                                        .app = app,
                                        .scenes = scenes,
                                        .assets = assets,
                                        .access = access});
  // Workers and browsers that come meanwhile wait at doors that are bound already.
  if (state) farm.open(std::filesystem::path(arguments.state) / "journal.db");
  farm.apply([&](const Farm& f, FarmTime now) { feeder.feed_on(f, now); });
  farm.when_changed([&] { asio::post(io, [&] { farm.keep(); }); });
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
  return 0;
}

}  // namespace
}  // namespace rayfarm

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("rayfarm-master"));
  rayfarm::Arguments arguments;
  CLI::App app("Shares pictures out among workers and this PC's own threads.", "rayfarm-master");
  rayfarm::declare(app, arguments);
  return rayfarm::run_daemon(app, argc, argv, [&] { return rayfarm::serve(arguments); });
}
