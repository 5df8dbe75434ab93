// From values to places along an axis, and the values that get a tick.
#pragma once
#include <string>
#include <vector>

#include "master/charts/chart.h"

namespace rayfarm {

struct Tick {
  double value = 0;
  std::string label;  // empty: a small tick
};

class AxisMap {
 public:
  /// `values`: all that is drawn.
  AxisMap(AxisScale scale, const std::vector<double>& values);

  /// 0 at the low end, 1 at the high one.
  double place(double value) const;
  std::vector<Tick> ticks() const;

 private:
  double scaled(double value) const;
  std::vector<Tick> decades() const;
  std::vector<Tick> steps() const;

  AxisScale scale_;
  bool has_zero_ = false;      // of a logarithmic axis: one decade is kept for it at the low end
  double low_ = 0, high_ = 1;  // as scaled
};

}  // namespace rayfarm
