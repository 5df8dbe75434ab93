// The texts of the live connection: what viewers are sent, and what they may say.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "master/http/live/hub.h"

namespace rayfarm {

SharedMessage text_message(const nlohmann::json& value);
nlohmann::json to_json(const LogLine& line, FarmTime now);
SharedMessage log_message(std::span<const LogLine> lines, FarmTime now);
/// `watch`: its place in the viewer's list.
SharedMessage layer_message(const LayerFeed& feed, std::size_t watch);

/// {"watch": [{"job": 7, "frame": 12, "layer": "depth", "reduce": "mean", "compat": true}, ...]}. Throws ApiError for
/// anything else.
std::vector<LayerName> layers_to_watch(const std::string& text);

}  // namespace rayfarm
