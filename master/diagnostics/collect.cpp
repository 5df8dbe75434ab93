#include "master/diagnostics/collect.h"

namespace rayfarm {

void PixelWatch::ended(const std::optional<Hit>& hit) {
  if (is_adaptive_)
    keep(hit);
  else if (hit)
    met(*hit);
}

void PixelWatch::met(const Hit& hit) { surfaces_.add(hit, 1); }

void PixelWatch::keep(const std::optional<Hit>& hit) { ends_.push_back(hit); }

}  // namespace rayfarm
