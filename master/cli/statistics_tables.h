// What rendering took, in tables: of a scene and of a job they have the same rows.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace rayfarm {

/// Of "counters" and "mean_per_pixel", as `rayfarm stats --json` has them.
std::string table_of_rays(const nlohmann::json& statistics);
/// Of tests_json().
std::string table_of_tests(const nlohmann::json& tests);
/// Of [{name, hits}]; the shares are of all of them.
std::string table_of_hits(const nlohmann::json& hits);
std::string table_of_times(const nlohmann::json& seconds, std::span<const char* const> phases);

/// "160x120 pixels, 16.000 samples per pixel"
std::string headline(const std::string& pixels, double samples_per_pixel);

}  // namespace rayfarm
