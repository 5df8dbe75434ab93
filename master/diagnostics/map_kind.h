// The maps there are: the one table that the command line, the HTTP interface, the files and the picture view
// all read. To add a map, add its entry in map_kind.cpp.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/render/camera_rays.h"
#include "common/render/counters.h"
#include "master/diagnostics/surfaces.h"

namespace rayfarm {

/// What must be known of a pixel for its value.
enum class MapSource : std::uint8_t {
  surfaces,  // where its primary rays end
  rays,      // all its rays, counted
  time,      // how long its rays take; the farm says it of a job's tiles
  farm,      // who rendered it: there are values for a job alone
};

/// How values are shown.
enum class MapScale : std::uint8_t { depth, count, normal, label };  // label: numbers that stand for names

/// What is known of a pixel when it has been traced, until the next one is.
struct PixelFacts {
  RayCounters rays;                  // of source surfaces: primary and primary_hits alone
  const Surface* surface = nullptr;  // as reduced; null where the pixel shows nothing
  std::uint64_t weight = 0;          // of all its samples
  double seconds = 0;                // of source time
};

/// What a map's values refer to beside the pixel.
struct MapView {
  CameraAxes axes;
  Vec3d eye{};
  bool compatible = false;  // as the original renderer computed it
};

struct MapKind {
  std::string_view name, title, unit, help;    // help: "distance to the first surface"
  std::span<const std::string_view> channels;  // as an EXR names them
  MapScale scale = MapScale::count;
  MapSource source = MapSource::surfaces;
  bool reduces = false;  // one value of many samples': --reduce says how
  bool has_compatible = false;
  /// The pixel's value, channels.size() numbers. None of source farm.
  void (*put)(const PixelFacts& pixel, const MapView& view, float* into) = nullptr;
};

std::span<const MapKind> all_maps();
/// The pixel's values of several maps at once: into[i] is where all_maps()[i] has its values, null where it is not
/// wanted; they are put at channels.size() * place.
void put_all(const PixelFacts& pixel, const MapView& view, std::size_t place, std::span<float* const> into);
const MapKind* map_named(std::string_view name);  // "depth", "normal-camera", ...; null: there is none

/// "depth, normal, ... or cost".
std::string map_names();
std::string listed(std::span<const std::string_view> names);  // "a, b or c"

}  // namespace rayfarm
