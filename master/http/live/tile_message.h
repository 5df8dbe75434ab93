// One tile of a layer as a viewer is sent it: a binary WebSocket message.
//
// Little-endian. Head, 32 bytes: u32 0x31544652 ("RFT1"), u32 layer id, u32 x, y, width, height (the area, in
// sent pixels), u16 stride, u8 channels, u8 format (0: float16, 1: float32), u32 0. Then ceil(height /
// stride) rows of ceil(width / stride) pixels of `channels` numbers: the value at each stride-th pixel, which
// fills its stride x stride square.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "master/diagnostics/layer.h"

namespace rayfarm {

/// What is sent, made once and shared by all who are sent it.
using SharedMessage = std::shared_ptr<const std::vector<std::uint8_t>>;

/// Every step-th pixel of a layer is sent.
struct SentLayer {
  std::uint32_t id = 0;
  Size size;  // of the whole layer
  std::size_t channels = 1;
  std::uint32_t step = 1;  // 1, 2, 4 or 8
};

/// The passes whose pixels are sent.
PassSet passes_sent(std::uint32_t step);

/// The finest grid of the tile that is complete; float16 until all that is sent is there, then float32. Null
/// when not even the coarsest is.
SharedMessage tile_message(const SentLayer& layer, const TileNews& news);

}  // namespace rayfarm
