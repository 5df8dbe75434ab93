// Settings and counters as the HTTP API shows them: one place for the server and for the command.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "common/render/counters.h"
#include "common/render/settings.h"

namespace rayfarm {

nlohmann::json to_json(const RenderSettings& settings);
/// Any of the members that to_json gives, others are as by default; checked. Throws SettingsError for what is
/// unknown, of a wrong type or out of range.
RenderSettings settings_from_json(const nlohmann::json& value);

nlohmann::json to_json(const RayCounters& counters);

}  // namespace rayfarm
