// The head of a frame in bytes that may be one.
#pragma once
#include "tests/fuzz/fuzz.h"

namespace rayfarm {

/// There are as many.
inline std::span<const std::uint8_t, frame_header_size> header_of(ByteView bytes) {
  return std::span<const std::uint8_t, frame_header_size>(bytes.first<frame_header_size>());
}

}  // namespace rayfarm
