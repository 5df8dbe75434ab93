#include "common/render/render.h"

#include <limits>

#include "common/render/trace.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t samples_between_questions = 16;  // a slow pixel must not delay a stop

/// Not NaN, not infinite, also not as the film's float.
bool is_finite(const Vec3d& c) {
  return max_abs(c) <= std::numeric_limits<float>::max() && c.x == c.x && c.y == c.y && c.z == c.z;
}

}  // namespace

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
      const PixelSampler sampler(settings, {x, y});
      Vec3d sum;
      for (std::uint32_t s = 0; s < settings.spp; ++s) {
        stopped = stopped || (s % samples_between_questions == 0 && stop());
        if (stopped) return;
        const Sample2D place = sampler.sample(s, 0);
        const Vec3d color = tracer.radiance(
            x + place.u, y + place.v, [&](std::uint32_t light) { return sampler.sample(s, 1 + light); });
        if (is_finite(color))
          sum += color;
        else
          ++image.counters.bad_samples;
      }
      for (int c = 0; c < 3; ++c) image.rgb.push_back(static_cast<float>(sum[c] / settings.spp));
    });
    if (stopped) return std::nullopt;
    image.counters += tracer.observer.counters;
    images.push_back(std::move(image));
  }
  return images;
}

}  // namespace rayfarm
