// A pixel from its samples: where the film's values come from, for who renders and for who watches.
#pragma once
#include <array>
#include <functional>
#include <limits>
#include <optional>

#include "common/render/sampler.h"
#include "common/render/trace.h"

namespace rayfarm {

/// The light of one sample, a pure function of (world, settings, pixel, sample).
template <class Observer>
Vec3d sample_radiance(Tracer<Observer>& tracer, const PixelSampler& sampler, Pixel pixel,
                      std::uint32_t sample) {
  const Sample2D place = sampler.sample(sample, 0);
  return tracer.radiance(pixel.x + place.u, pixel.y + place.v,
                         [&](std::uint32_t light) { return sampler.sample(sample, 1 + light); });
}

/// The samples of a pixel, added in their order.
struct PixelSum {
  Vec3d sum{};
  std::uint64_t bad_samples = 0;  // NaN or infinite, also as the film's float; they add nothing

  void add(const Vec3d& c) {
    if (max_abs(c) <= std::numeric_limits<float>::max() && c.x == c.x && c.y == c.y && c.z == c.z)
      sum += c;
    else
      ++bad_samples;
  }
  std::array<float, 3> mean(std::uint32_t samples) const {
    return {static_cast<float>(sum.x / samples), static_cast<float>(sum.y / samples),
            static_cast<float>(sum.z / samples)};
  }
};

/// All samples of a pixel; nothing when stop(), asked every few hundred rays, has said true.
template <class Observer, class Stop>
std::optional<PixelSum> pixel_sum(Tracer<Observer>& tracer, const RenderSettings& settings, Pixel pixel,
                                  const Stop& stop) {
  tracer.stop = std::ref(stop);
  const PixelSampler sampler(settings, pixel);
  PixelSum sum;
  for (std::uint32_t s = 0; s < settings.spp && !tracer.is_stopped(); ++s)
    sum.add(sample_radiance(tracer, sampler, pixel, s));
  tracer.stop = nullptr;
  return tracer.is_stopped() ? std::nullopt : std::optional(sum);
}

}  // namespace rayfarm
