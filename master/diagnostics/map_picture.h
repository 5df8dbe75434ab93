// A map to look at and to compute with: colours, raw channels, a table.
#pragma once
#include <string>

#include "master/diagnostics/map.h"
#include "master/files/image_file.h"

namespace rayfarm {

/// In the original renderer's colours: counts and costs from blue (few) over green and yellow to red; depths
/// from white (near) to black (far, nothing), logarithmic; normals as RGB, facing the camera blue; labels in
/// colours far apart.
Picture colored(const Map& map, const MapKind& kind);
/// The raw values as an EXR's channels, under the map's names.
Picture raw(const Map& map, const MapKind& kind);
/// One line per image row, semicolons, after a line that says `title`; vectors as columns; nothing is inf.
std::string csv(const Map& map, const std::string& title);

}  // namespace rayfarm
