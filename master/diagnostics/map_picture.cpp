#include "master/diagnostics/map_picture.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "common/math/deterministic.h"
#include "common/math/number.h"

namespace rayfarm {
namespace {

using Rgb = std::array<double, 3>;  // 0..255 as shown

struct Range {
  double low = infinity, high = -infinity;  // of the finite values; low > high when there are none
};

Range range_of(const std::vector<float>& values) {
  Range range;
  for (const double v : values)
    if (std::isfinite(v)) range.low = least(range.low, v), range.high = greatest(range.high, v);
  return range;
}

/// Hue 240 (blue) for the lowest to 0 (red) for the highest, full colours.
Rgb count_color(double value, const Range& range) {
  const double hue = range.low == range.high ? 0 : 240 - 240 * (value - range.low) / (range.high - range.low);
  const double sextant = hue / 60, part = sextant - std::floor(sextant);
  const double up = std::floor(255 * part + 0.5), down = std::floor(255 * (1 - part) + 0.5);
  if (sextant < 1) return {255, up, 0};
  if (sextant < 2) return {down, 255, 0};
  if (sextant < 3) return {0, 255, up};
  if (sextant < 4) return {0, down, 255};
  return {up, 0, 255};
}

Rgb depth_color(double value, const Range& range) {
  if (!std::isfinite(value)) return {0, 0, 0};
  const double most = deterministic::log(range.high - range.low + 1);
  const double share = most > 0 ? deterministic::log(value - range.low + 1) / most : 0;
  const double grey = 255 - std::floor(255 * share);
  return {grey, grey, grey};
}

Rgb normal_color(const float* n) {
  if (!std::isfinite(n[0])) return {0, 0, 0};
  const auto byte = [](double component) { return std::floor((component + 1) * 127.499); };
  return {byte(n[0]), byte(n[1]), 255 - byte(n[2])};
}

/// Hues a golden angle apart: neighbours in number differ most.
Rgb label_color(double value) {
  if (!std::isfinite(value)) return {0, 0, 0};
  const double turns = value * 0.6180339887;
  return count_color(turns - std::floor(turns), {0, 1});
}

Rgb color_of(const float* value, MapScale scale, const Range& range) {
  switch (scale) {
    case MapScale::depth:
      return depth_color(*value, range);
    case MapScale::count:
      return count_color(*value, range);
    case MapScale::normal:
      return normal_color(value);
    case MapScale::label:
      return label_color(*value);
  }
  return {};
}

}  // namespace

Picture colored(const Map& map, const MapKind& kind) {
  const Range range = range_of(map.values);
  Picture picture{map.size, {}, {}};
  picture.rgb.reserve(map.values.size() / map.channels * 3);
  for (std::size_t i = 0; i < map.values.size(); i += map.channels)
    // Linear, so that the picture's gamma of 2.2 gives the bytes again.
    for (const double byte : color_of(&map.values[i], kind.scale, range))
      picture.rgb.push_back(static_cast<float>(deterministic::pow(byte / 255, 2.2)));
  return picture;
}

Picture raw(const Map& map, const MapKind& kind) {
  return {map.size, {}, {}, {{{kind.channels.begin(), kind.channels.end()}, map.values}}};
}

std::string csv(const Map& map, const std::string& title) {
  std::string text = "# " + title + '\n';
  const std::size_t columns = map.size.width * map.channels;
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    char number[32];
    text.append(number, std::to_chars(number, number + sizeof number, map.values[i]).ptr);
    text += (i + 1) % columns == 0 ? '\n' : ';';
  }
  return text;
}

}  // namespace rayfarm
