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
/// A decoder takes memory by the row, before it sees any pixel.
constexpr std::size_t max_image_side = 64 << 10;

/// The linear light of an sRGB code, both 0 to 1. Source: IEC 61966-2-1.
double linear_of_srgb(double code);

/// The linear light of a pixel.
Vec3d linear_at(const Image& image, std::size_t x, std::size_t y);

/// What makes an image of this size unusable; empty: nothing.
std::string fault_of_image_size(std::size_t width, std::size_t height);
/// What makes the image unusable; empty: nothing.
std::string fault_of(const Image& image);

}  // namespace rayfarm
