// Maps: one value (or vector) a pixel that says how the picture came about.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "common/render/camera_rays.h"
#include "common/render/settings.h"
#include "master/diagnostics/surfaces.h"
#include "master/files/image_file.h"

namespace rayfarm {

enum class MapKind : std::uint8_t {
  depth,          // distance to the first surface
  normal,         // of the first surface, world axes
  normal_camera,  // the same in the camera's axes: right, up, forward
  primary_rays,   // primary rays that hit something
  all_rays,       // rays of every kind that hit something, and shadow rays
  samples,        // primary rays
  cost,           // seconds on one thread; another time it is another one
};

/// Unit, at right angles.
struct CameraAxes {
  Vec3d right{}, up{}, forward{};
};
CameraAxes axes_of(const CameraRays& camera, Size film);

std::optional<MapKind> map_named(std::string_view name);  // "depth", "normal-camera", ...
std::optional<Reduction> reduction_named(std::string_view name);

/// What a map shows beside scene and settings.
struct MapRequest {
  MapKind kind = MapKind::depth;
  Reduction reduction = Reduction::majority;  // of depths and normals
  bool compatible = false;  // all-rays without shadow rays, normal-camera by the original renderer's formula
};

struct Map {
  Size size;
  std::size_t channels = 1;
  std::vector<float> values;  // row-major, `channels` a pixel; infinite where the pixel shows nothing
};

/// Only what the map asks for is traced: primary rays alone for depth, normals, primary-rays and samples.
/// Nothing is returned when stop() said so; it is asked from all threads.
std::optional<Map> map_of(const World& world, const RenderSettings& settings, const MapRequest& request,
                          unsigned threads, const std::function<bool()>& stop,
                          const std::function<void(std::uint32_t done, std::uint32_t all)>& progress);

/// In the original renderer's colours: counts and costs from blue (few) over green and yellow to red; depths
/// from white (near) to black (far, nothing), logarithmic; normals as RGB, facing the camera blue.
Picture colored(const Map& map, MapKind kind);
/// The raw values as a picture's red, green and blue; a single value in all three.
Picture raw(const Map& map);
/// One line per image row, semicolons, after a line that says `title`; vectors as columns; nothing is inf.
std::string csv(const Map& map, const std::string& title);

}  // namespace rayfarm
