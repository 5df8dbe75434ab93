#include "common/scene/image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/math/deterministic.h"

namespace rayfarm {

std::string fault_of_image_size(std::size_t width, std::size_t height) {
  if (width == 0 || height == 0) return "has no pixels";
  if (width > max_image_side || height > max_image_side)
    return "has a side of more than " + std::to_string(max_image_side) + " pixels";
  if (width * height > max_image_pixels)
    return "has more than " + std::to_string(max_image_pixels >> 20) + " megapixels";
  return {};
}

std::string fault_of(const Image& image) {
  if (const std::string fault = fault_of_image_size(image.width, image.height); !fault.empty()) return fault;
  const std::size_t pixels = std::size_t{image.width} * image.height;
  if (std::visit([](const auto& values) { return values.size(); }, image.values) != 3 * pixels)
    return "has not three values a pixel";
  if (const auto* linear = std::get_if<std::vector<float>>(&image.values))
    if (!std::ranges::all_of(*linear, [](float x) { return std::isfinite(x) && x >= 0; }))
      return "has a pixel that is negative or not finite";
  return {};
}

double linear_of_srgb(double code) {
  return code <= 0.04045 ? code / 12.92 : deterministic::pow((code + 0.055) / 1.055, 2.4);
}

Vec3d linear_at(const Image& image, std::size_t x, std::size_t y) {
  static const std::array<double, 256> linear = [] {
    std::array<double, 256> of_code;
    for (std::size_t code = 0; code < of_code.size(); ++code)
      of_code[code] = linear_of_srgb(static_cast<double>(code) / 255);
    return of_code;
  }();
  const std::size_t first = 3 * (y * image.width + x);
  if (const auto* codes = std::get_if<std::vector<std::uint8_t>>(&image.values))
    return {linear[(*codes)[first]], linear[(*codes)[first + 1]], linear[(*codes)[first + 2]]};
  const auto& values = std::get<std::vector<float>>(image.values);
  return {values[first], values[first + 1], values[first + 2]};
}

}  // namespace rayfarm
