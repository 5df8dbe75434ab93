#include "master/files/difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "master/files/flip.h"

namespace rayfarm {
namespace {

constexpr std::array<std::string_view, 4> metric_names{"rmse", "mae", "max", "flip"};

std::string text_of(Size size) { return std::to_string(size.width) + "x" + std::to_string(size.height); }

float distance(float a, float b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  if (!std::isfinite(a) || !std::isfinite(b)) return std::numeric_limits<float>::infinity();
  return std::fabs(a - b);
}

double value_of(const std::vector<float>& distances, Metric metric) {
  double sum = 0, largest = 0;
  for (const float d : distances) {
    sum += metric == Metric::rmse ? double{d} * d : double{d};
    largest = std::max(largest, double{d});
  }
  if (metric == Metric::max) return largest;
  const double mean = distances.empty() ? 0 : sum / static_cast<double>(distances.size());
  return metric == Metric::rmse ? std::sqrt(mean) : mean;
}

}  // namespace

std::string_view name_of(Metric metric) { return metric_names[static_cast<std::size_t>(metric)]; }

std::optional<Metric> metric_named(std::string_view name) {
  for (std::size_t i = 0; i < metric_names.size(); ++i)
    if (metric_names[i] == name) return static_cast<Metric>(i);
  return std::nullopt;
}

Difference difference(const Picture& a, const Picture& b, Metric metric) {
  if (!(a.size == b.size))
    throw FileError("pictures of different size cannot be compared: " + text_of(a.size) + " and " +
                    text_of(b.size));

  Difference result;
  result.picture.size = a.size;
  if (metric == Metric::flip) {
    result.picture.rgb = flip_error(a, b);
  } else {
    result.picture.rgb.resize(a.rgb.size());
    std::transform(a.rgb.begin(), a.rgb.end(), b.rgb.begin(), result.picture.rgb.begin(), distance);
  }
  result.value = value_of(result.picture.rgb, metric);
  return result;
}

}  // namespace rayfarm
