#include "common/scene/image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/math/deterministic.h"

namespace rayfarm {

std::string fault_of(const Image& image) {
  const std::size_t pixels = std::size_t{image.width} * image.height;
  if (pixels == 0) return "has no pixels";
  if (pixels > max_image_pixels)
    return "has more than " + std::to_string(max_image_pixels >> 20) + " megapixels";
  if (std::visit([](const auto& values) { return values.size(); }, image.values) != 3 * pixels)
    return "has not three values a pixel";
  if (const auto* linear = std::get_if<std::vector<float>>(&image.values))
    if (!std::ranges::all_of(*linear, [](float x) { return std::isfinite(x) && x >= 0; }))
      return "has a pixel that is negative or not finite";
  return {};
}

namespace {

/// Source: IEC 61966-2-1 (sRGB).
std::array<double, 256> linear_of_srgb() {
  std::array<double, 256> linear;
  for (std::size_t code = 0; code < linear.size(); ++code) {
    const double x = static_cast<double>(code) / 255;
    linear[code] = x <= 0.04045 ? x / 12.92 : deterministic::pow((x + 0.055) / 1.055, 2.4);
  }
  return linear;
}

}  // namespace

Vec3d linear_at(const Image& image, std::size_t x, std::size_t y) {
  static const std::array<double, 256> linear = linear_of_srgb();
  const std::size_t first = 3 * (y * image.width + x);
  if (const auto* codes = std::get_if<std::vector<std::uint8_t>>(&image.values))
    return {linear[(*codes)[first]], linear[(*codes)[first + 1]], linear[(*codes)[first + 2]]};
  const auto& values = std::get<std::vector<float>>(image.values);
  return {values[first], values[first + 1], values[first + 2]};
}

}  // namespace rayfarm
