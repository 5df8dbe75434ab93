#include "master/cli/local_render.h"

#include <mutex>

#include "common/render/render.h"
#include "common/work/each_tile.h"

namespace rayfarm {

std::optional<LocalRender> render_locally(Size size, unsigned threads, const RenderTile& render,
                                          const std::function<void(const Film&)>& progress) {
  LocalRender result{Film(size), {}};
  std::mutex mutex;  // guards result
  const auto work = [&](std::uint32_t tile) {
    const auto images = render(tile);
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
  if (!each_tile(size, threads, work, show)) return std::nullopt;
  return result;
}

std::optional<LocalRender> render_locally(const World& world, const RenderSettings& settings,
                                          unsigned threads, const std::function<bool()>& stop,
                                          const std::function<void(const Film&)>& progress) {
  const auto render = [&](std::uint32_t tile) {
    return render_tile(world, settings, tile, all_passes, stop);
  };
  return render_locally({settings.width, settings.height}, threads, render, progress);
}

}  // namespace rayfarm
