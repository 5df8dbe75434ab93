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
  /// World and settings must outlive it. Maps as map_of() makes them, for the kinds' majorities.
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
  template <class Observer>
  Images render_maps(Observer observer, std::uint32_t tile, PassSet passes,
                     const std::function<bool()>& stop);
  void put(Pixel pixel, const PixelFacts& facts);

  const World& world_;
  const RenderSettings& settings_;
  MapView view_;
  bool is_timed_ = false;
  std::vector<Map> maps_;  // each pixel is written by one thread
  /// Where a map's values go.
  struct Outlet {
    decltype(MapKind::put) put;
    float* values;
    std::size_t channels;
  };
  std::vector<Outlet> outlets_;  // of maps_
  CloudFile* cloud_ = nullptr;
  std::vector<std::uint32_t> ranks_;  // of the tiles, by number
};

}  // namespace rayfarm
