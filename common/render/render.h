// The renderer: the pixels of some passes of a tile, as a pure function of world, settings and pixel.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "common/render/film.h"
#include "common/render/settings.h"
#include "common/render/tile.h"
#include "common/render/world.h"

namespace rayfarm {

class PixelWatch;  // trace.h

/// Renders `passes` of the tile, coarse first. Asks stop() between samples; when it says true the call
/// returns nothing, and what was rendered of the tile is dropped. Every sample is a pure function of (world,
/// settings, pixel, sample index): no thread, order or tile matters. The watch, if any, is told of each pixel.
std::optional<std::vector<PassImage>> render_tile(const World& world, const RenderSettings& settings,
                                                  std::uint32_t tile, PassSet passes,
                                                  const std::function<bool()>& stop,
                                                  PixelWatch* watch = nullptr);
/// The same of any part of the film whose corner lies on the coarsest pass's grid: a tile, or a piece of one.
std::optional<std::vector<PassImage>> render_area(const World& world, const RenderSettings& settings,
                                                  const Tile& area, PassSet passes,
                                                  const std::function<bool()>& stop);

}  // namespace rayfarm
