// What a submitter sends, as JSON: read strictly, and never trusted.
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "master/farm.h"
#include "master/http/api_error.h"
#include "master/http/asset_store.h"

namespace rayfarm {

constexpr std::uint64_t submission_limit = 64 * 1024 * 1024;  // bytes of JSON
constexpr std::uint64_t largest_scene =
    submission_limit / 4 * 3 - 16384;  // as base64, beside the other members

/// Bounded in depth and number of values, so that its tree stays smaller than a small multiple of the text.
/// Throws ApiError.
nlohmann::json parse_json(const std::string& text);

/// {scene, assets, frames, name, output, priority, hold, key, verify, parameters, settings}: only the scene (base64 of
/// encode_scene) must be there; assets is a list of hashes, of those that were uploaded. The scene is decoded and
/// checked. Throws ApiError, SettingsError, SceneError or CodecError.
JobSpec job_spec(const nlohmann::json& body, AssetStore& store);
/// All of a submission but its scene and settings. Throws ApiError, also for what no submission has, and SettingsError.
JobSpec job_wishes(const nlohmann::json& body);
nlohmann::json to_json(const JobSpec& spec);

/// Another frame of a job: {frame, scene, assets}.
struct SubmittedFrame {
  std::uint32_t number = 0;
  SceneData scene;
  std::vector<AssetData> assets;
};
/// Throws as job_spec().
SubmittedFrame frame_from_json(const nlohmann::json& body, AssetStore& store);
nlohmann::json to_json(const SubmittedFrame& frame);

int priority_from_json(const nlohmann::json& value);

}  // namespace rayfarm
