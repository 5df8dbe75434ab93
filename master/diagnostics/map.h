// Maps: one value (or vector) a pixel that says how the picture came about.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "common/render/settings.h"
#include "master/diagnostics/collect.h"

namespace rayfarm {

/// What a map shows beside scene and settings.
struct MapRequest {
  const MapKind* kind = map_named("depth");
  Reduction reduction = Reduction::majority;  // of a kind that reduces
  bool compatible = false;                    // of a kind that has it
  bool operator==(const MapRequest&) const = default;
};

struct Map {
  Size size;
  std::size_t channels = 1;
  std::vector<float> values;  // row-major, `channels` a pixel; infinite where the pixel shows nothing
};

/// Puts the value of a pass's pixel into the square that it stands for until finer passes of the tile come.
void fill(Map& map, const Tile& tile, int pass, Pixel pixel, const float* value);

MapView view_of(const World& world, const RenderSettings& settings, bool compatible);

/// The values of one pixel after another, in one thread. Only what the map asks for is traced.
class PixelMapper {
 public:
  /// The kind must have values without a farm. World and settings must outlive the mapper.
  PixelMapper(const World& world, const RenderSettings& settings, const MapRequest& request);
  PixelMapper(const PixelMapper&) = delete;

  /// What its samples say of the pixel; nothing when stop() said so.
  std::optional<PixelFacts> facts(Pixel pixel, const std::function<bool()>& stop);
  /// Writes kind->channels.size() numbers; false, and nothing of use, when stop() said so.
  bool put(Pixel pixel, float* into, const std::function<bool()>& stop);

 private:
  bool trace_first_hits(Pixel pixel, const std::function<bool()>& stop);

  const RenderSettings& settings_;
  MapRequest request_;
  MapView view_;
  Tracer<CountingObserver> tracer_;
  SurfaceWatch watch_;
};

/// Nothing is returned when stop() said so; it is asked from all threads.
std::optional<Map> map_of(const World& world, const RenderSettings& settings, const MapRequest& request,
                          unsigned threads, const std::function<bool()>& stop,
                          const std::function<void(std::uint32_t done, std::uint32_t all)>& progress);

}  // namespace rayfarm
