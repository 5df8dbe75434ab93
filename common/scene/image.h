// A decoded image, as textures show it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "common/math/vec.h"

namespace rayfarm {

/// Row by row from the top, three values a pixel: red, green, blue.
struct Image {
  std::uint32_t width = 0, height = 0;
  /// sRGB codes of an 8 bit file, or linear light.
  std::variant<std::vector<std::uint8_t>, std::vector<float>> values;
  bool operator==(const Image&) const = default;
};

constexpr std::size_t max_image_pixels = 64 << 20;

/// The linear light of a pixel.
Vec3d linear_at(const Image& image, std::size_t x, std::size_t y);

/// What makes the image unusable; empty: nothing.
std::string fault_of(const Image& image);

}  // namespace rayfarm
