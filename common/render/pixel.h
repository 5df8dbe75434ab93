// A pixel from its samples: where the film's values come from, for who renders and for who watches.
#pragma once
#include <array>
#include <functional>
#include <limits>
#include <optional>

#include "common/render/adapt1.h"
#include "common/render/sampler.h"
#include "common/render/signature.h"
#include "common/render/trace.h"

namespace rayfarm {

/// A sample of a pixel that has been traced: a pure function of (world, settings, pixel, number).
struct TakenSample {
  std::uint32_t number = 0;  // among the pixel's, in the order in which they were traced
  Sample2D at;               // on the pixel
  Vec3d color{};
  std::uint32_t weight = 1;  // all of a pixel's add up to pixel_weight()
};

/// Whether what the first samples of a pixel show decides where it takes more: then they are known only when
/// all are traced. Any other sampler takes spp samples, PixelSampler::sample(0 .. spp - 1, 0), of weight 1.
constexpr bool is_adaptive(SamplerKind kind) { return kind == SamplerKind::adapt1; }

inline std::uint32_t pixel_weight(const RenderSettings& s) {
  return is_adaptive(s.sampler) ? adapt1::smallest_cells(s.spp) : s.spp;
}

/// Traces one sample of a sampler that is not adaptive.
template <class Observer>
TakenSample taken_sample(Tracer<Observer>& tracer, const PixelSampler& sampler, Pixel pixel,
                         std::uint32_t number) {
  const Sample2D at = sampler.sample(number, 0);
  return {number, at, tracer.radiance(pixel.x + at.u, pixel.y + at.v, [&](std::uint32_t light) {
            return sampler.sample(number, 1 + light);
          })};
}

/// Traces the samples of an adaptive sampler, then visits them.
template <class Observer, class Visit>
void visit_adaptive_samples(Tracer<Observer>& tracer, const PixelSampler& sampler, std::uint32_t spp,
                            Pixel pixel, Visit&& visit) {
  const adapt1::Quadtree tree(sampler, spp, [&](std::uint32_t cell, const Sample2D& at) {
    Signature signature(tracer.world());
    const auto light_point = [&](std::uint32_t light) { return sampler.sample(cell, 1 + light); };
    const Vec3d color = tracer.radiance(pixel.x + at.u, pixel.y + at.v, light_point, signature);
    return adapt1::Seen{color, signature.value()};
  });
  std::uint32_t number = 0;
  for (const adapt1::Sample& s : tree.samples()) {
    if (tracer.watch()) tracer.watch()->sample_weighed(number, s.weight);
    visit(TakenSample{number++, s.at, s.seen.color, s.weight});
  }
}

/// Traces the samples of a pixel: the very ones of the picture, for whoever renders, counts or watches.
/// visit(TakenSample) hears of each, by number; of an adaptive sampler's only when all are traced. False when
/// stop(), asked every few hundred rays, has said true: what was visited is of no use then.
template <class Observer, class Stop, class Visit>
bool visit_samples(Tracer<Observer>& tracer, const RenderSettings& settings, Pixel pixel, const Stop& stop,
                   Visit&& visit) {
  tracer.stop_when(std::ref(stop));
  const PixelSampler sampler(settings, pixel);
  if (is_adaptive(settings.sampler))
    visit_adaptive_samples(tracer, sampler, settings.spp, pixel, visit);
  else
    for (std::uint32_t s = 0; s < settings.spp && !tracer.is_stopped(); ++s)
      visit(taken_sample(tracer, sampler, pixel, s));
  tracer.stop_when(nullptr);
  return !tracer.is_stopped();
}

/// The samples of a pixel, added in their order.
struct PixelSum {
  Vec3d sum{};
  std::uint64_t bad_samples = 0;  // NaN or infinite, also as the film's float; they add nothing

  void add(const Vec3d& c, std::uint32_t weight) {
    if (max_abs(c) <= std::numeric_limits<float>::max() && c.x == c.x && c.y == c.y && c.z == c.z)
      sum += c * static_cast<double>(weight);
    else
      ++bad_samples;
  }
  std::array<float, 3> mean(std::uint32_t weight) const {
    return {static_cast<float>(sum.x / weight), static_cast<float>(sum.y / weight),
            static_cast<float>(sum.z / weight)};
  }
};

/// All samples of a pixel; nothing when stop() has said true.
template <class Observer, class Stop>
std::optional<PixelSum> pixel_sum(Tracer<Observer>& tracer, const RenderSettings& settings, Pixel pixel,
                                  const Stop& stop) {
  PixelSum sum;
  const bool complete = visit_samples(tracer, settings, pixel, stop, [&](const TakenSample& sample) {
    sum.add(sample.color, sample.weight);
  });
  return complete ? std::optional(sum) : std::nullopt;
}

/// What pictures are rendered with: in one place (render.cpp), so that it is the same code whoever else watches.
extern template class Tracer<CountingObserver>;
extern template std::optional<PixelSum> pixel_sum(Tracer<CountingObserver>&, const RenderSettings&, Pixel,
                                                  const std::function<bool()>&);

}  // namespace rayfarm
