// A whole picture by the threads of this PC, without a farm.
#pragma once
#include <functional>
#include <optional>

#include "common/render/film.h"
#include "common/render/settings.h"
#include "common/render/world.h"

namespace rayfarm {

struct LocalRender {
  Film film;
  RayCounters counters;
};

/// All passes of a tile, or nothing when it is to stop; called from all threads.
using RenderTile = std::function<std::optional<std::vector<PassImage>>(std::uint32_t tile)>;

/// Tiles nearest the centre first. `progress(film)` is called about ten times a second from the calling
/// thread while no pixel is put. Nothing is returned when stop() said so; it is asked from all threads.
std::optional<LocalRender> render_locally(const World& world, const RenderSettings& settings,
                                          unsigned threads, const std::function<bool()>& stop,
                                          const std::function<void(const Film&)>& progress);
/// The same by a renderer of the caller's.
std::optional<LocalRender> render_locally(Size size, unsigned threads, const RenderTile& render,
                                          const std::function<void(const Film&)>& progress);

}  // namespace rayfarm
