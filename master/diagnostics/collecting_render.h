// A picture and, from the same samples, what lies behind it: maps, a cloud of surface points.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "common/render/film.h"
#include "master/diagnostics/cloud.h"
#include "master/diagnostics/map.h"

namespace rayfarm {

class CollectingRender {
 public:
  /// World and settings must outlive it. Maps as map_of() makes them, for the kinds' majorities; no kind twice.
  CollectingRender(const World& world, const RenderSettings& settings,
                   const std::vector<const MapKind*>& maps);
  /// Points go to `cloud`, which must outlive this, a rank for each tile in the order of centre_first().
  void also_collect(CloudFile& cloud);

  /// As render_tile() (common/render/render.h), the same pixels and counters. From many threads at once, each
  /// tile once, begun in the order of centre_first().
  std::optional<std::vector<PassImage>> render_tile(std::uint32_t tile, PassSet passes,
                                                    const std::function<bool()>& stop);

  /// When all tiles are rendered: the maps, in the order in which they were asked for.
  std::vector<Map>& maps() { return maps_; }

 private:
  using Images = std::optional<std::vector<PassImage>>;

  const World& world_;
  const RenderSettings& settings_;
  MapView view_;
  bool is_timed_ = false;
  std::vector<Map> maps_;     // each pixel is written by one thread
  std::vector<float*> into_;  // where the values of each map of all_maps() go; null: nowhere
  CloudFile* cloud_ = nullptr;
  std::vector<std::uint32_t> ranks_;  // of the tiles, by number
};

}  // namespace rayfarm
