// Scenes that come as a script, or by the name of one that the master offers.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "master/http/scene_library.h"
#include "master/http/submission.h"

namespace rayfarm {

constexpr std::size_t longest_script = 1 << 20;  // bytes

/// Of a script that is looked at for its form: shorter than to be rendered, since people try and mistype there.
constexpr ScriptLimits look_limits{
    .wall = std::chrono::seconds(5), .cpu_seconds = 5, .memory_bytes = 512ull << 20};

/// Whether who asked waits no longer: the evaluation then ends soon.
using HasLeft = std::function<bool()>;

/// {script, name}: what the script declares. Evaluates it. Throws ApiError and SceneError.
ScriptFacts script_facts(const nlohmann::json& body, const HasLeft& has_left = {});
nlohmann::json to_json(const ScriptFacts& facts);
nlohmann::json to_json(const OfferedScene& scene);

struct SubmittedJob {
  JobSpec spec;
  std::optional<ScriptRequest> script;  // that the other frames come from; none: its submitter sends them
};

/// What POST /jobs brings: with `scene` as job_spec(), else with `scene_name`, or with `script` (and
/// script_name), and `parameters`. The script is evaluated; a setting not given is the scene's, then the
/// built-in one. Throws what job_spec() throws.
SubmittedJob submitted_job(const nlohmann::json& body, const SceneLibrary& library, AssetStore& store,
                           const HasLeft& has_left = {});

}  // namespace rayfarm
