// A float in 16 bits: sign, 5 bits of exponent, 10 of fraction (IEEE 754 binary16).
#pragma once
#include <bit>
#include <cstdint>

namespace rayfarm {

/// Rounded to the nearest, ties to even. Infinities and NaNs stay; from 65,520 on it is infinite.
constexpr std::uint16_t half_of(float number) {
  const auto bits = std::bit_cast<std::uint32_t>(number);
  const std::uint32_t magnitude = bits & 0x7fffffffu;
  const auto with_sign = [&](std::uint32_t half) {
    return static_cast<std::uint16_t>(half | (bits >> 16 & 0x8000u));
  };
  if (magnitude > 0x7f800000u) return with_sign(0x7e00u | (magnitude >> 13 & 0x3ffu));
  if (magnitude >= 0x477ff000u) return with_sign(0x7c00u);
  // Below the least normal half: 0.5 has the place value of the least half, 2^-24, so the sum is rounded there.
  if (magnitude < 0x38800000u)
    return with_sign(std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) + 0.5f) - 0x3f000000u);
  const std::uint32_t rebased = magnitude - (112u << 23);
  return with_sign((rebased + 0xfffu + (rebased >> 13 & 1u)) >> 13);
}

}  // namespace rayfarm
