// The passes of a tile, for whoever renders and watches at once.
#pragma once
#include <optional>
#include <vector>

#include "common/render/film.h"
#include "common/render/pixel.h"

namespace rayfarm {

/// Renders `passes` of the tile, coarse first. sum_of(Pixel) traces the pixel's samples by the tracer and gives
/// their sum, or nothing when it is to stop: then nothing is returned. The observer counts.
template <class Observer, class SumOf>
std::optional<std::vector<PassImage>> render_passes(Tracer<Observer>& tracer, const RenderSettings& settings,
                                                    std::uint32_t tile_number, PassSet passes,
                                                    SumOf&& sum_of) {
  const Tile tile = tile_at({settings.width, settings.height}, tile_number);
  std::vector<PassImage> images;
  bool stopped = false;
  for (int pass = 0; pass < pass_count; ++pass) {
    if (!(passes >> pass & 1)) continue;
    PassImage image{pass, {}, {}};
    image.rgb.reserve(3 * std::size_t{pixel_count(tile, pass)});
    tracer.observer.counters = {};
    for_each_pixel(tile, pass, [&](std::uint32_t x, std::uint32_t y) {
      if (stopped) return;
      const std::optional<PixelSum> sum = sum_of(Pixel{x, y});
      stopped = !sum;
      if (stopped) return;
      image.counters.bad_samples += sum->bad_samples;
      for (const float value : sum->mean(pixel_weight(settings))) image.rgb.push_back(value);
    });
    if (stopped) return std::nullopt;
    image.counters += tracer.observer.counters;
    images.push_back(std::move(image));
  }
  return images;
}

}  // namespace rayfarm
