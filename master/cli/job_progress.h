// A job's progress as the commands show it.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "master/cli/progress_line.h"

namespace rayfarm {

/// How far it is, and when it is paused, why.
void show(ProgressLine& line, const nlohmann::json& job);
void show_pause(ProgressLine& line, const nlohmann::json& job);
double fraction_done(const nlohmann::json& job);
std::string eta_text(const nlohmann::json& job);  // empty: not known
/// "frames 0-499:5", "frame 12"
std::string frames_text(const nlohmann::json& job);

}  // namespace rayfarm
