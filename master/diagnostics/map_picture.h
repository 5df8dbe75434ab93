// A map to look at and to compute with: colours, raw channels, a table.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "master/diagnostics/map.h"
#include "master/files/image_file.h"

namespace rayfarm {

enum class MapPalette : std::uint8_t {
  // The original renderer's: counts and costs from blue (few) over green and yellow to red, linear; depths from
  // white (near) to black (far, nothing), by log(depth - nearest + 1).
  original,
  // Equal steps look equal. Counts and costs in viridis (S. van der Walt and N. Smith, 2015, CC0); depths in
  // greys of equal steps of CIE lightness for equal ratios of distance, nothing alone is black.
  perceptual,
};
std::optional<MapPalette> palette_named(std::string_view name);

/// Of finite values; low > high when there are none.
struct MapRange {
  double low = 0, high = 0;
};
MapRange range_of(const Map& map);
/// That of its colours when none is asked for: of times all but the lowest and highest hundredth, as a thread that had
/// to wait once would make all others look alike; else all.
MapRange usual_range(const Map& map, const MapKind& kind);

/// How values become colours. Normals are RGB, facing the camera blue, and labels colours far apart, whatever
/// the palette and the range.
struct MapColors {
  MapPalette palette = MapPalette::original;
  std::optional<MapRange> range;  // for two pictures to be compared; without it the usual one
};

/// Bytes as the original renderer shows them, 0 to 255.
using MapColor = std::array<std::uint8_t, 3>;
/// The colour of one pixel's value (kind.channels.size() numbers).
MapColor color_of(const float* value, MapScale scale, MapPalette palette, const MapRange& range);

/// Linear, so that a PNG of gamma 2.2 has the colours' bytes.
Picture colored(const Map& map, const MapKind& kind, const MapColors& colors = {});
/// The same with the meaning of the colours beside it: a bar with the values of its ends, the ball of all
/// normals, or the numbers of the labels.
Picture colored_with_legend(const Map& map, const MapKind& kind, const MapColors& colors = {});

/// The raw values as an EXR's channels, under the map's names.
Picture raw(const Map& map, const MapKind& kind);
/// One line per image row, semicolons, after a line that says `title`; vectors as columns; nothing is inf.
std::string csv(const Map& map, const std::string& title);

}  // namespace rayfarm
