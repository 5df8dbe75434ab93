// A scene made ready to be rendered, tile by tile.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "common/render/film.h"
#include "common/render/settings.h"
#include "common/scene/scene.h"

namespace rayfarm {

/// Renders passes of a tile, or of a piece of one, coarse first; asks stop() between samples, and gives nothing once that
/// has said true.
/// May be called by several threads at once.
using TileRenderer = std::function<std::optional<std::vector<PassImage>>(
    const RenderSettings& settings, const Tile& area, PassSet passes, const std::function<bool()>& stop)>;

/// How a scene becomes ready; tests have simpler ways. What it throws is for people.
using PrepareScene = std::function<TileRenderer(Scene scene)>;

/// Builds the scene's World; render_area() does the rest.
TileRenderer prepare_scene(Scene scene);

}  // namespace rayfarm
