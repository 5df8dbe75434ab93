// What a pixel's samples say about it, noted while they are traced.
#pragma once
#include <functional>
#include <vector>

#include "common/render/pixel.h"
#include "master/diagnostics/map_kind.h"

namespace rayfarm {

/// Counts rays and notes the surfaces of one pixel after another.
class PixelObserver : public CountingObserver {
 public:
  PixelObserver(const World& world, const RenderSettings& settings, Reduction reduction)
      : surfaces_(world, reduction),
        all_weight_(pixel_weight(settings)),
        is_adaptive_(is_adaptive(settings.sampler)) {}

  void begin_pixel() {
    before_ = counters;
    surfaces_.clear();
    ends_.clear();
  }

  void traced(RayKind kind, const Ray& ray, std::uint32_t depth, double importance,
              const std::optional<Hit>& hit) {
    CountingObserver::traced(kind, ray, depth, importance, hit);
    if (kind == RayKind::primary) met(hit);
  }
  void no_ray() { met(std::nullopt); }

  /// To be called for each sample that visit_samples() visits.
  void visited(const TakenSample& sample) {
    if (is_adaptive_ && ends_[sample.number]) surfaces_.add(*ends_[sample.number], sample.weight);
  }

  /// What is known of the pixel now; the caller adds the time.
  PixelFacts facts() const { return {counters - before_, surfaces_.reduced(all_weight_), all_weight_}; }
  const PixelSurfaces& surfaces() const { return surfaces_; }

 private:
  /// Out of line, so that the tracer's code stays as it is for who watches nothing.
  void met(const std::optional<Hit>& hit);
  /// Samples of an adaptive sampler have their weight only when all of the pixel's are traced.
  [[gnu::noinline]] void keep(const std::optional<Hit>& hit);

  PixelSurfaces surfaces_;
  std::uint64_t all_weight_;
  bool is_adaptive_;
  RayCounters before_;
  std::vector<std::optional<Hit>> ends_;  // of an adaptive sampler, by number
};

}  // namespace rayfarm
