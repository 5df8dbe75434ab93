// What the command lines of both daemons have in common.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>

namespace rayfarm {

/// --version, --config FILE (TOML, with the options as keys; the command line stands above it), --insecure;
/// and the examples at the end of --help.
void declare_common_options(CLI::App& app, bool& insecure, const std::string& examples);

/// Parses, then serves; the exit code. What serve() throws is printed: it is about how the program was
/// called.
int run_daemon(CLI::App& app, int argc, char** argv, const std::function<void()>& serve);

}  // namespace rayfarm
