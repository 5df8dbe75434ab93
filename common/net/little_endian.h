// Numbers as bytes, lowest first, for the formats that are not cereal's.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace rayfarm {

inline void append_u16(std::vector<std::uint8_t>& out, std::uint16_t n) {
  for (int shift = 0; shift < 16; shift += 8) out.push_back(static_cast<std::uint8_t>(n >> shift));
}
inline void append_u32(std::vector<std::uint8_t>& out, std::uint32_t n) {
  for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(n >> shift));
}
inline std::uint16_t read_u16(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
}
inline std::uint32_t read_u32(std::span<const std::uint8_t> bytes) {
  return read_u16(bytes) | std::uint32_t{read_u16(bytes.subspan(2))} << 16;
}

}  // namespace rayfarm
