// A worker that lies: its renderer changes what an honest one made.
#pragma once
#include <cmath>
#include <functional>

#include "common/work/tile_renderer.h"

namespace rayfarm {

/// Each hundredth pixel by the smallest step that there is.
inline void lie_by_one_ulp(std::vector<PassImage>& images) {
  for (PassImage& image : images)
    for (std::size_t i = 0; i < image.rgb.size(); i += 300)
      image.rgb[i] = std::nextafter(image.rgb[i], 2 * image.rgb[i] + 1);
}

inline PrepareScene lying(PrepareScene honest, std::function<void(std::vector<PassImage>&)> lie) {
  return [=](Scene scene) -> TileRenderer {
    return [render = honest(std::move(scene)), lie](const auto&... what) {
      auto images = render(what...);
      if (images) lie(*images);
      return images;
    };
  };
}

}  // namespace rayfarm
