// The commands that people type, one function for each file of them: it declares options and help, and says
// through `chosen` what to run when its command was typed.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>

#include "master/cli/exit_code.h"

namespace rayfarm {

using Command = std::function<ExitCode()>;

void add_render_command(CLI::App& app, Command& chosen);
void add_stats_command(CLI::App& app, Command& chosen);
void add_map_command(CLI::App& app, Command& chosen);
void add_cloud_command(CLI::App& app, Command& chosen);
void add_trace_command(CLI::App& app, Command& chosen);
void add_chart_command(CLI::App& app, Command& chosen);
void add_compare_command(CLI::App& app, Command& chosen);
void add_submit_command(CLI::App& app, Command& chosen);
void add_job_commands(CLI::App& app, Command& chosen);  // jobs, job, watch, pause, resume, cancel, priority
void add_fetch_command(CLI::App& app, Command& chosen);
void add_worker_commands(CLI::App& app, Command& chosen);  // workers, drain, undrain, ban, unban
void add_token_command(CLI::App& app, Command& chosen);    // token new, list, revoke

}  // namespace rayfarm
