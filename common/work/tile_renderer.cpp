#include "common/work/tile_renderer.h"

#include <memory>

#include "common/render/render.h"

namespace rayfarm {

TileRenderer prepare_scene(Scene scene) {
  const auto world = std::make_shared<const World>(std::move(scene));
  return [world](const RenderSettings& settings, const Tile& area, PassSet passes,
                 const std::function<bool()>& stop) {
    return render_area(*world, settings, area, passes, stop);
  };
}

}  // namespace rayfarm
