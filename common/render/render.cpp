#include "common/render/render.h"

#include "common/render/pixel.h"

namespace rayfarm {

std::optional<std::vector<PassImage>> render_tile(const World& world, const RenderSettings& settings,
                                                  std::uint32_t tile_number, PassSet passes,
                                                  const std::function<bool()>& stop) {
  const Tile tile = tile_at({settings.width, settings.height}, tile_number);
  Tracer<CountingObserver> tracer(world, settings);
  std::vector<PassImage> images;
  bool stopped = false;
  for (int pass = 0; pass < pass_count; ++pass) {
    if (!(passes >> pass & 1)) continue;
    PassImage image{pass, {}, {}};
    image.rgb.reserve(3 * std::size_t{pixel_count(tile, pass)});
    tracer.observer = {};
    for_each_pixel(tile, pass, [&](std::uint32_t x, std::uint32_t y) {
      if (stopped) return;
      const std::optional<PixelSum> sum = pixel_sum(tracer, settings, {x, y}, stop);
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
