// What a picture's header says about it.
#pragma once
#include <map>
#include <string>

#include "common/render/settings.h"

namespace rayfarm {

/// Only what follows from scene, settings, seed and version, so that whole files are equal wherever the
/// picture was rendered; facts of the run belong to the job. `scene_hash`: SHA-256 of encode_scene(),
/// hexadecimal.
std::map<std::string, std::string> facts_of(const std::string& scene_hash, const RenderSettings& settings);

}  // namespace rayfarm
