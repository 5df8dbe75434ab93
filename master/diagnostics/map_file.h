// What a map's file says about it, so that all who write one write the same bytes.
#pragma once
#include <map>
#include <string>

#include "master/diagnostics/map.h"

namespace rayfarm {

/// What the map was made of.
struct MapOrigin {
  MapRequest request;
  std::string scene_hash;
  RenderSettings settings;
  std::vector<std::string> labels{};  // names of the values 0, 1, ... of a label map
};

/// "rayfarm map depth majority (scene units), 64x48 pixels, ...": the first line of a CSV.
std::string title_of(const MapOrigin& origin);
/// For a picture's header.
std::map<std::string, std::string> facts_of(const MapOrigin& origin);

}  // namespace rayfarm
