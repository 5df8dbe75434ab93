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

/// Tiles nearest the centre first. `progress(film)` is called about ten times a second from the calling
/// thread while no pixel is put. Nothing is returned when stop() said so; it is asked from all threads.
std::optional<LocalRender> render_locally(const World& world, const RenderSettings& settings,
                                          unsigned threads, const std::function<bool()>& stop,
                                          const std::function<void(const Film&)>& progress);

}  // namespace rayfarm
