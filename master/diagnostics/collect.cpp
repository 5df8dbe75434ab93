#include "master/diagnostics/collect.h"

namespace rayfarm {

void SurfaceWatch::pixel_begins(const RayCounters& counters) {
  before_ = counters;
  surfaces_.clear();
  ends_.clear();
}

void SurfaceWatch::ray_ended(const std::optional<Hit>& hit) {
  if (hears_misses)
    ends_.push_back(hit);
  else if (hit)
    surfaces_.add(*hit, 1);
}

void SurfaceWatch::sample_weighed(std::uint32_t number, std::uint32_t weight) {
  if (ends_[number]) surfaces_.add(*ends_[number], weight);
}

}  // namespace rayfarm
