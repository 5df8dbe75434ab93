// What a pixel's samples say about it, noted while they are traced.
#pragma once
#include <optional>
#include <vector>

#include "common/render/pixel.h"
#include "master/diagnostics/map_kind.h"

namespace rayfarm {

/// Notes the surfaces of one pixel after another.
class SurfaceWatch : public PixelWatch {
 public:
  SurfaceWatch(const World& world, const RenderSettings& settings, Reduction reduction)
      : PixelWatch(is_adaptive(settings.sampler)),
        surfaces_(world, reduction),
        all_weight_(pixel_weight(settings)) {}

  void pixel_begins(const RayCounters& counters) final;
  void pixel_ended(Pixel, const RayCounters&) override {}
  void ray_ended(const std::optional<Hit>& hit) final;
  void sample_weighed(std::uint32_t number, std::uint32_t weight) final;

  /// What is known of the pixel when it has ended; the caller adds the time.
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

}  // namespace rayfarm
