#include "master/diagnostics/collect.h"

namespace rayfarm {

void PixelWatch::ended(const std::optional<Hit>& hit) {
  if (hears_misses)
    ends_.push_back(hit);
  else if (hit)
    surfaces_.add(*hit, 1);
}

}  // namespace rayfarm
