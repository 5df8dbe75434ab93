// The `rayfarm` command: what people type.
#include <signal.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include "common/render/settings.h"
#include "master/cli/commands.h"
#include "master/cli/interrupt.h"
#include "master/cli/text.h"
#include "master/files/image_file.h"
#include "master/script/suggestion.h"

namespace rayfarm {
namespace {

/// What was printed and could not be written (a full disk) is no success.
void expect_printed() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    throw CommandError(ExitCode::failed,
                       std::string("cannot write to standard output: ") + std::strerror(errno));
}

/// Every failure ends here, with one line and its exit code.
ExitCode run(const Command& command) {
  const auto ended = [](ExitCode code, const char* message) {
    const ExitCode told = interrupted() ? ExitCode::interrupted : code;
    std::fprintf(stderr, "rayfarm: %s\n", message);
    return told;
  };
  try {
    const ExitCode code = command();
    expect_printed();
    return code;
  } catch (const CommandError& error) {
    return ended(error.code, error.what());
  } catch (const SceneError& error) {
    return ended(ExitCode::usage, error.what());
  } catch (const SettingsError& error) {
    return ended(ExitCode::usage, error.what());
  } catch (const FileError& error) {
    return ended(ExitCode::usage, error.what());
  } catch (const std::bad_alloc&) {
    return ended(ExitCode::failed, "not enough memory; try a smaller --size");
  } catch (const std::exception& error) {
    return ended(ExitCode::failed, error.what());
  }
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

/// CLI11 would say that a command is missing, not that this one is misspelt.
bool knows(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = names_of_commands(app);
  return std::find(names.begin(), names.end(), word) != names.end();
}
int complain(const CLI::App& app, const std::string& word) {
  std::fprintf(stderr, "rayfarm: there is no command %s%s; rayfarm --help lists them\n",
               printable(word).c_str(), suggestion(word, names_of_commands(app)).c_str());
  return static_cast<int>(ExitCode::usage);
}

int run_command_line(int argc, char** argv) {
  CLI::App app("rayfarm: ray tracing on all PCs of a lab, or on this one", "rayfarm");
  app.set_version_flag("--version", "rayfarm " RAYFARM_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  rayfarm render scenes/circus.lua -o circus.png\n"
      "  rayfarm submit scenes/circus.lua -o circus.exr --size 1920x1080 --spp 256 --watch\n"
      "  rayfarm jobs\n"
      "Environment: RAYFARM_MASTER, the master's address (default http://127.0.0.1:5412);\n"
      "RAYFARM_TOKEN_FILE, a file with your token, which only you may read.\n"
      "Exit codes: 0 done, 1 failed, 2 usage, scene or output, 3 master unreachable, 4 not allowed,\n"
      "5 timed out, 6 version refused, 7 partly done, 130 interrupted.");
  Command chosen;
  add_render_command(app, chosen);
  add_submit_command(app, chosen);
  add_job_commands(app, chosen);
  add_fetch_command(app, chosen);
  add_worker_commands(app, chosen);
  add_token_command(app, chosen);
  add_stats_command(app, chosen);
  add_map_command(app, chosen);
  add_cloud_command(app, chosen);
  add_trace_command(app, chosen);
  add_compare_command(app, chosen);
  add_chart_command(app, chosen);
  if (argc > 1 && argv[1][0] != '-' && !knows(app, argv[1])) return complain(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::usage);
  }
  return static_cast<int>(run(chosen));
}

}  // namespace
}  // namespace rayfarm

int main(int argc, char** argv) {
  ::signal(SIGXFSZ, SIG_IGN);  // a file over the user's limit is an error to report, not a reason to die
  return rayfarm::run_command_line(argc, argv);
}
