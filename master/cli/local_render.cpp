#include "master/cli/local_render.h"

#include <mutex>

#include "common/render/render.h"
#include "common/work/each_tile.h"

namespace rayfarm {

std::optional<LocalRender> render_locally(const World& world, const RenderSettings& settings,
                                          unsigned threads, const std::function<bool()>& stop,
                                          const std::function<void(const Film&)>& progress) {
  const Size size{settings.width, settings.height};
  LocalRender result{Film(size), {}};
  std::mutex mutex;  // guards result
  const auto render = [&](std::uint32_t tile) {
    const auto images = render_tile(world, settings, tile, all_passes, stop);
    if (!images) return false;
    const std::lock_guard lock(mutex);
    for (const PassImage& image : *images) {
      result.film.put(tile, image);
      result.counters += image.counters;
    }
    return true;
  };
  const auto show = [&] {
    const std::lock_guard lock(mutex);
    progress(result.film);
  };
  if (!each_tile(size, threads, render, show)) return std::nullopt;
  return result;
}

}  // namespace rayfarm
