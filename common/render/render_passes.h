// The passes of a tile, for whoever renders and observes at once.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "common/render/film.h"
#include "common/render/pixel.h"

namespace rayfarm {

/// As render_area() (render.h), by a tracer whose observer counts, and with its watch if it has one.
template <class Observer>
std::optional<std::vector<PassImage>> render_passes(Tracer<Observer>& tracer, const RenderSettings& settings,
                                                    const Tile& area, PassSet passes,
                                                    const std::function<bool()>& stop) {
  std::vector<PassImage> images;
  bool stopped = false;
  for (int pass = 0; pass < pass_count; ++pass) {
    if (!(passes >> pass & 1)) continue;
    PassImage image{pass, {}, {}};
    image.rgb.reserve(3 * std::size_t{pixel_count(area, pass)});
    tracer.observer.counters = {};
    for_each_pixel(area, pass, [&](std::uint32_t x, std::uint32_t y) {
      if (stopped) return;
      if (tracer.watch()) tracer.watch()->pixel_begins(tracer.observer.counters);
      const std::optional<PixelSum> sum = pixel_sum(tracer, settings, Pixel{x, y}, stop);
      stopped = !sum;
      if (stopped) return;
      if (tracer.watch()) tracer.watch()->pixel_ended({x, y}, tracer.observer.counters);
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
