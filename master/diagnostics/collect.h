// What a pixel's samples say about it, noted while they are traced.
#pragma once
#include <functional>
#include <vector>

#include "common/render/pixel.h"
#include "master/diagnostics/map_kind.h"

namespace rayfarm {

/// Notes the surfaces of one pixel after another.
class PixelWatch : public PrimaryWatch {
 public:
  PixelWatch(const World& world, const RenderSettings& settings, Reduction reduction)
      : PrimaryWatch(is_adaptive(settings.sampler)),
        surfaces_(world, reduction),
        all_weight_(pixel_weight(settings)) {}

  /// Of the pixels before it, so much has been counted.
  void begin_pixel(const RayCounters& counters) {
    before_ = counters;
    surfaces_.clear();
    ends_.clear();
  }

  void ended(const std::optional<Hit>& hit) override;

  /// To be called for each sample of an adaptive sampler when the pixel's are visited: then their weights are known.
  void visited(const TakenSample& sample) {
    if (ends_[sample.number]) surfaces_.add(*ends_[sample.number], sample.weight);
  }

  /// What is known of the pixel now; the caller adds the time.
  PixelFacts facts(const RayCounters& counters) {
    return {counters - before_, surfaces_.reduced(all_weight_), all_weight_};
  }

 private:
  PixelSurfaces surfaces_;
  std::uint64_t all_weight_;
  RayCounters before_;
  // Samples of an adaptive sampler have their weight only when all of the pixel's are traced: by number.
  std::vector<std::optional<Hit>> ends_;
};

/// As pixel_sum(), of a tracer whose primary rays the watch watches; begin_pixel() and facts() are the caller's.
template <class Observer, class Stop>
std::optional<PixelSum> watched_sum(Tracer<Observer>& tracer, const RenderSettings& settings, Pixel pixel,
                                    const Stop& stop, PixelWatch& watch) {
  if (!is_adaptive(settings.sampler)) return pixel_sum(tracer, settings, pixel, stop);
  PixelSum sum;
  const bool complete = visit_samples(tracer, settings, pixel, stop, [&](const TakenSample& sample) {
    sum.add(sample.color, sample.weight);
    watch.visited(sample);
  });
  return complete ? std::optional(sum) : std::nullopt;
}

}  // namespace rayfarm
