#include "master/charts/axis_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace rayfarm {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

/// The next of 1, 2, 5 times a power of ten that is not smaller.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= step) return factor * power;
  return 10 * power;
}

}  // namespace

AxisMap::AxisMap(AxisScale scale, const std::vector<double>& values) : scale_(scale) {
  std::vector<double> shown;
  for (const double value : values) {
    if (scale_ == AxisScale::linear)
      shown.push_back(value);
    else if (value > 0)
      shown.push_back(std::log10(value));
    else
      has_zero_ = true;
  }
  if (shown.empty()) shown = {0, 1};
  const auto [least, most] = std::minmax_element(shown.begin(), shown.end());
  low_ = *least, high_ = *most;
  if (scale_ == AxisScale::logarithmic) {
    const double room = (high_ - low_) / 8;
    low_ -= has_zero_ ? std::max(1.0, room) : 0;
  }
  const double margin = high_ > low_ ? 0.03 * (high_ - low_) : 0.5;
  low_ -= margin, high_ += margin;
}

double AxisMap::scaled(double value) const {
  if (scale_ == AxisScale::linear) return value;
  return value > 0 ? std::log10(value) : low_ + 0.03 * (high_ - low_);
}

double AxisMap::place(double value) const { return (scaled(value) - low_) / (high_ - low_); }

std::vector<Tick> AxisMap::ticks() const { return scale_ == AxisScale::linear ? steps() : decades(); }

std::vector<Tick> AxisMap::decades() const {
  std::vector<Tick> ticks;
  double first = low_;
  if (has_zero_) {
    ticks.push_back({0, "0"});
    first += 0.09 * (high_ - low_);
  }
  const double every = std::ceil((high_ - low_) / 8);
  for (double decade = std::ceil(first); decade <= high_; ++decade) {
    const bool is_labelled = std::fmod(decade, every) == 0;
    const std::string label = std::fabs(decade) <= 3 ? number(std::pow(10.0, decade)) : "1e" + number(decade);
    ticks.push_back({std::pow(10.0, decade), is_labelled ? label : ""});
  }
  if (high_ - low_ > 2) return ticks;
  for (double decade = std::floor(first); decade <= high_; ++decade)
    for (const int digit : {2, 5}) {
      const double value = digit * std::pow(10.0, decade);
      if (std::log10(value) >= first && std::log10(value) <= high_) ticks.push_back({value, number(value)});
    }
  return ticks;
}

std::vector<Tick> AxisMap::steps() const {
  std::vector<Tick> ticks;
  const double step = round_step((high_ - low_) / 6);
  for (double k = std::ceil(low_ / step); k * step <= high_; ++k)
    ticks.push_back({k * step, number(k * step + 0.0)});  // -0 as 0
  return ticks;
}

}  // namespace rayfarm
