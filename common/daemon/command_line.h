// What the command lines of both daemons have in common.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>

namespace rayfarm {

/// Where a daemon does without encryption and certificates; at most one. Neither: between programs of one PC.
struct Openness {
  bool insecure = false;  // everywhere
  bool closed = false;    // nowhere
};

/// --version, --config FILE (TOML, with the options as keys; the command line stands above it), --insecure, --closed;
/// and the examples at the end of --help.
void declare_common_options(CLI::App& app, Openness& openness, const std::string& examples);

/// Parses, then serves; the exit code, which is that of serve(). What serve() throws is printed: it is about how the
/// program was called.
int run_daemon(CLI::App& app, int argc, char** argv, const std::function<int()>& serve);

}  // namespace rayfarm
