#include "master/diagnostics/collect.h"

namespace rayfarm {

void PixelObserver::met(const std::optional<Hit>& hit) {
  if (is_adaptive_) return keep(hit);
  if (hit) surfaces_.add(*hit, 1);
}

void PixelObserver::keep(const std::optional<Hit>& hit) { ends_.push_back(hit); }

}  // namespace rayfarm
