// A job whose pixels are known without tracing a ray, and ways to hold its rendering in the middle.
#pragma once
#include <atomic>

#include "common/net/codec.h"
#include "common/work/tile_renderer.h"

namespace rayfarm {

/// One sphere and a light.
Scene simple_scene();
/// With its hash.
SceneData scene_data(const Scene& scene);

/// The pixel values are their positions: what travels and where it is put can be seen.
std::optional<std::vector<PassImage>> position_tile(const RenderSettings& settings, std::uint32_t tile,
                                                    PassSet passes, const std::function<bool()>& stop);
std::optional<std::vector<PassImage>> position_area(const RenderSettings& settings, const Tile& area,
                                                    PassSet passes, const std::function<bool()>& stop);
/// position_area() for any scene.
TileRenderer prepare_positions(Scene scene);

/// Renderers that wait in the middle of each tile until they are let go or told to stop.
class Gate {
 public:
  PrepareScene prepare();
  /// Waits until so many tiles have been begun in all.
  void wait_for_begun(int tiles);
  /// Waits until so many have been told to stop.
  void wait_for_stopped(int tiles);
  int begun() const { return begun_; }
  int stopped() const { return stopped_; }
  void open();

 private:
  std::atomic<int> begun_{0}, stopped_{0};
  std::atomic<bool> open_{false};
};

}  // namespace rayfarm
