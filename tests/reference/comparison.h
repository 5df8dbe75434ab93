// The core against the reference tracer: first hit and colour of the same rays.
//
// The two may differ by what the reference itself changes when its ray is moved by 1e-9 of the picture's
// width. So a smooth place must agree to many digits, a pixel may differ only where the ray grazes an edge
// within rounding, and these are counted: a missing surface or a speckle fails.
#pragma once
#include <string>

#include "common/render/settings.h"
#include "common/render/world.h"
#include "tests/reference/reference_tracer.h"

namespace rayfarm {

class Comparison {
 public:
  Comparison(std::string name, const Scene& scene, const RenderSettings& settings);

  /// Adds a test failure when the two do not agree at this point of the film.
  void compare_at(double x, double y);
  /// Every pixel of the rows y0 <= y < y1, at that place of it: its centre; stops after ten failures.
  void compare_rows(std::uint32_t y0, std::uint32_t y1, double place = 0.5);
  /// Few rays pass so near an edge that rounding decides.
  void expect_few_at_edges() const;

 private:
  std::string name_;
  Scene scene_;
  RenderSettings settings_;
  ReferenceSettings reference_;
  ReferenceTracer tracer_;
  World world_;
  int rays_ = 0, wrong_ = 0, at_edges_ = 0;
};

}  // namespace rayfarm
