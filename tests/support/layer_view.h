// What a viewer makes of the tiles that it is sent.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <stdexcept>
#include <vector>

#include "common/render/tile.h"

namespace rayfarm {

inline float float_of_half(std::uint16_t half) {
  const int exponent = half >> 10 & 31, fraction = half & 1023;
  const float sign = half & 0x8000 ? -1.0f : 1.0f;
  if (exponent == 31) return fraction ? std::nanf("") : sign * INFINITY;
  return sign * (exponent ? std::ldexp(1024.0f + fraction, exponent - 25) : std::ldexp(1.0f * fraction, -24));
}

struct ReceivedTile {
  std::uint32_t layer = 0, x = 0, y = 0, width = 0, height = 0;
  std::uint16_t stride = 0;
  std::uint8_t channels = 0;
  bool is_float32 = false;
  std::vector<float> values;
};

/// Throws std::runtime_error for what is no tile.
inline ReceivedTile received_tile(std::span<const std::uint8_t> bytes) {
  const auto at = [&](std::size_t place, auto number) {
    if (place + sizeof number > bytes.size()) throw std::runtime_error("the tile is too short");
    std::memcpy(&number, bytes.data() + place, sizeof number);
    return number;
  };
  const auto u32 = [&](std::size_t place) { return at(place, std::uint32_t{}); };
  if (u32(0) != 0x31544652 || u32(28) != 0) throw std::runtime_error("this is no tile");
  ReceivedTile tile{u32(4),
                    u32(8),
                    u32(12),
                    u32(16),
                    u32(20),
                    at(24, std::uint16_t{}),
                    at(26, std::uint8_t{}),
                    at(27, std::uint8_t{}) == 1,
                    {}};
  const auto across = [&](std::uint32_t side) { return (side + tile.stride - 1) / tile.stride; };
  const std::size_t numbers = std::size_t{across(tile.width)} * across(tile.height) * tile.channels;
  if (bytes.size() != 32 + numbers * (tile.is_float32 ? 4 : 2))
    throw std::runtime_error("the tile has a wrong size");
  for (std::size_t i = 0; i < numbers; ++i)
    tile.values.push_back(tile.is_float32 ? at(32 + 4 * i, float{})
                                          : float_of_half(at(32 + 2 * i, std::uint16_t{})));
  return tile;
}

/// A layer as its viewer sees it.
class LayerView {
 public:
  LayerView(Size size, std::size_t channels)
      : size_(size), channels_(channels), values_(std::size_t{size.width} * size.height * channels) {}

  void put(const ReceivedTile& tile) {
    const std::uint32_t across = (tile.width + tile.stride - 1) / tile.stride;
    for (std::uint32_t y = 0; y < tile.height; ++y)
      for (std::uint32_t x = 0; x < tile.width; ++x) {
        const float* from =
            &tile.values[(std::size_t{y / tile.stride} * across + x / tile.stride) * channels_];
        std::copy_n(from, channels_,
                    &values_[(std::size_t{tile.y + y} * size_.width + tile.x + x) * channels_]);
      }
    if (tile.is_float32 && tile.stride == 1) finished_pixels_[{tile.x, tile.y}] = tile.width * tile.height;
  }
  std::uint64_t finished_pixels() const {
    std::uint64_t sum = 0;
    for (const auto& [place, pixels] : finished_pixels_) sum += pixels;
    return sum;
  }
  bool is_complete() const { return finished_pixels() == std::uint64_t{size_.width} * size_.height; }
  const std::vector<float>& values() const { return values_; }

 private:
  Size size_;
  std::size_t channels_;
  std::vector<float> values_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> finished_pixels_;  // by tile
};

}  // namespace rayfarm
