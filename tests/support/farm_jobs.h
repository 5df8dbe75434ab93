// Jobs for a farm, and what their films must show.
#pragma once
#include "master/farm.h"
#include "tests/support/simple_job.h"

namespace rayfarm {

inline JobSpec simple_job(RenderSettings settings) {
  const SceneData scene = scene_data(simple_scene());
  JobSpec spec;
  spec.name = "simple";
  spec.scene_hash = scene.hash;
  spec.scene_bytes = scene.bytes;
  spec.settings = settings;
  return spec;
}

/// The film that a renderer makes alone, tile after tile.
inline Film rendered(const TileRenderer& renderer, const RenderSettings& settings) {
  Film film({settings.width, settings.height});
  for (std::uint32_t tile = 0; tile < tile_count(film.size()); ++tile) {
    const auto images = renderer(settings, tile_at(film.size(), tile), all_passes, [] { return false; });
    for (const PassImage& image : *images) film.put(tile, image);
  }
  return film;
}

}  // namespace rayfarm
