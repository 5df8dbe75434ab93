// How far two pictures are apart.
#pragma once
#include <optional>
#include <string_view>

#include "master/files/image_file.h"

namespace rayfarm {

enum class Metric : std::uint8_t { rmse, mae, max, flip };

std::string_view name_of(Metric metric);
std::optional<Metric> metric_named(std::string_view name);

struct Difference {
  double value = 0;  // 0: equal
  Picture picture;   // where: per pixel and channel, not negative
};

/// rmse, mae: root mean square and mean absolute error over all pixels and channels of linear values; max:
/// the largest absolute one; flip: the mean of the LDR-FLIP error map, 0..1. Two not-a-numbers or equal
/// infinities are equal, any other one is infinitely far. Throws FileError unless the pictures have the same
/// size.
Difference difference(const Picture& a, const Picture& b, Metric metric);

}  // namespace rayfarm
