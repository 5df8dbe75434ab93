#include "master/diagnostics/map_picture.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "common/math/deterministic.h"
#include "common/math/number.h"

namespace rayfarm {
namespace {

std::uint8_t byte_of(double whole) { return static_cast<std::uint8_t>(whole); }

constexpr MapColor black{0, 0, 0};

/// Where a value lies between the range's ends, 0 to 1.
double share_of(double value, const MapRange& range) {
  return std::clamp((value - range.low) / (range.high - range.low), 0.0, 1.0);
}

/// Hue 240 (blue) at 0 to 0 (red) at 1, full colours.
MapColor rainbow(double share) {
  const double sextant = 4 - 4 * share, part = sextant - std::floor(sextant);
  const auto up = byte_of(std::floor(255 * part + 0.5)), down = byte_of(std::floor(255 * (1 - part) + 0.5));
  if (sextant < 1) return {255, up, 0};
  if (sextant < 2) return {down, 255, 0};
  if (sextant < 3) return {0, 255, up};
  if (sextant < 4) return {0, down, 255};
  return {up, 0, 255};
}

/// Linear between nine of viridis' colours.
MapColor viridis(double share) {
  constexpr std::array<MapColor, 9> colors{{{0x44, 0x01, 0x54},
                                            {0x47, 0x2d, 0x7b},
                                            {0x3b, 0x52, 0x8b},
                                            {0x2c, 0x72, 0x8e},
                                            {0x21, 0x91, 0x8c},
                                            {0x28, 0xae, 0x80},
                                            {0x5e, 0xc9, 0x62},
                                            {0xad, 0xdc, 0x30},
                                            {0xfd, 0xe7, 0x25}}};
  const double place = share * (colors.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), colors.size() - 2);
  MapColor color;
  for (std::size_t c = 0; c < 3; ++c) {
    const double step = colors[below + 1][c] - colors[below][c];
    color[c] = byte_of(std::floor(colors[below][c] + step * (place - static_cast<double>(below)) + 0.5));
  }
  return color;
}

MapColor count_color(double value, MapPalette palette, const MapRange& range) {
  if (!std::isfinite(value)) return black;
  // As the original: where all are equal, all are many.
  const double share = range.low < range.high ? share_of(value, range) : 1;
  return palette == MapPalette::original ? rainbow(share) : viridis(share);
}

MapColor grey(double byte) { return {byte_of(byte), byte_of(byte), byte_of(byte)}; }

MapColor original_depth(double value, const MapRange& range) {
  const double most = deterministic::log(range.high - range.low + 1);
  const double behind = std::clamp(value, range.low, range.high) - range.low;
  return grey(255 - std::floor(255 * (most > 0 ? deterministic::log(behind + 1) / most : 0)));
}

MapColor perceptual_depth(double value, const MapRange& range) {
  constexpr double nearest = 97, farthest = 12;  // CIE lightness; nothing has 0
  const double low = greatest(range.low, 1e-6 * range.high);
  const double share =
      low < range.high
          ? std::clamp(deterministic::log(greatest(value, low) / low) / deterministic::log(range.high / low),
                       0.0, 1.0)
          : 0;
  // Luminance by CIE 15, for lightness above 8.
  const double luminance = deterministic::pow((nearest + (farthest - nearest) * share + 16) / 116, 3);
  return grey(std::floor(255 * deterministic::pow(luminance, 1 / 2.2) + 0.5));
}

MapColor depth_color(double value, MapPalette palette, const MapRange& range) {
  if (!std::isfinite(value)) return black;
  return palette == MapPalette::original ? original_depth(value, range) : perceptual_depth(value, range);
}

MapColor normal_color(const float* n) {
  if (!std::isfinite(n[0])) return black;
  const auto byte = [](double component) { return byte_of(std::floor((component + 1) * 127.499)); };
  return {byte(n[0]), byte(n[1]), static_cast<std::uint8_t>(255 - byte(n[2]))};
}

/// Hues a golden section of the circle apart: neighbours in number differ most.
MapColor label_color(double value) {
  if (!std::isfinite(value)) return black;
  const double turns = value * 0.6180339887498949;
  return rainbow(turns - std::floor(turns));
}

}  // namespace

std::optional<MapPalette> palette_named(std::string_view name) {
  if (name == "original") return MapPalette::original;
  if (name == "perceptual") return MapPalette::perceptual;
  return std::nullopt;
}

MapRange range_of(const Map& map) {
  MapRange range{infinity, -infinity};
  for (const double v : map.values)
    if (std::isfinite(v)) range.low = least(range.low, v), range.high = greatest(range.high, v);
  return range;
}

MapRange usual_range(const Map& map, const MapKind& kind) {
  if (kind.source != MapSource::time || map.values.empty()) return range_of(map);
  std::vector<float> sorted = map.values;  // times are finite
  std::sort(sorted.begin(), sorted.end());
  const std::size_t cut = sorted.size() / 100;
  return {sorted[cut], sorted[sorted.size() - 1 - cut]};
}

MapColor color_of(const float* value, MapScale scale, MapPalette palette, const MapRange& range) {
  switch (scale) {
    case MapScale::depth:
      return depth_color(*value, palette, range);
    case MapScale::count:
      return count_color(*value, palette, range);
    case MapScale::normal:
      return normal_color(value);
    case MapScale::label:
      return label_color(*value);
  }
  return black;
}

Picture colored(const Map& map, const MapKind& kind, const MapColors& colors) {
  std::array<float, 256> linear;
  for (std::size_t byte = 0; byte < linear.size(); ++byte)
    linear[byte] = static_cast<float>(deterministic::pow(static_cast<double>(byte) / 255, 2.2));
  const MapRange range = colors.range.value_or(usual_range(map, kind));
  Picture picture{map.size, {}, {}};
  picture.rgb.reserve(map.values.size() / map.channels * 3);
  for (std::size_t i = 0; i < map.values.size(); i += map.channels)
    for (const std::uint8_t byte : color_of(&map.values[i], kind.scale, colors.palette, range))
      picture.rgb.push_back(linear[byte]);
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
