#include "common/work/tile_renderer.h"

#include <memory>

#include "common/render/render.h"

namespace rayfarm {

TileRenderer prepare_scene(Scene scene) {
  const auto world = std::make_shared<const World>(std::move(scene));
  return [world](const RenderSettings& settings, std::uint32_t tile, PassSet passes,
                 const std::function<bool()>& stop) {
    return render_tile(*world, settings, tile, passes, stop);
  };
}

}  // namespace rayfarm
