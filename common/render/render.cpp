#include "common/render/render.h"

#include "common/render/render_passes.h"

namespace rayfarm {

template class Tracer<CountingObserver>;
template std::optional<PixelSum> pixel_sum(Tracer<CountingObserver>&, const RenderSettings&, Pixel,
                                           const std::function<bool()>&);

std::optional<std::vector<PassImage>> render_tile(const World& world, const RenderSettings& settings,
                                                  std::uint32_t tile, PassSet passes,
                                                  const std::function<bool()>& stop, PixelWatch* watch) {
  Tracer<CountingObserver> tracer(world, settings);
  tracer.set_watch(watch);
  return render_passes(tracer, settings, tile_at({settings.width, settings.height}, tile), passes, stop);
}

std::optional<std::vector<PassImage>> render_area(const World& world, const RenderSettings& settings,
                                                  const Tile& area, PassSet passes,
                                                  const std::function<bool()>& stop) {
  Tracer<CountingObserver> tracer(world, settings);
  return render_passes(tracer, settings, area, passes, stop);
}

}  // namespace rayfarm
