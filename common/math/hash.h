// Random numbers by counting: hashes of 64-bit keys.
// Source of the finaliser: D. Stafford, Better Bit Mixing (Mix13), 2011, as used by SplitMix64 (G. L. Steele,
// D. Lea, C. H. Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014).
#pragma once
#include <cstdint>

namespace rayfarm {

constexpr std::uint64_t mixed(std::uint64_t x) {
  x ^= x >> 30, x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27, x *= 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A key made from another one and a number.
constexpr std::uint64_t keyed(std::uint64_t key, std::uint64_t number) {
  return mixed(key + 0x9e3779b97f4a7c15u * (number + 1));
}

/// 0 <= x < 1, from the upper 53 bits.
constexpr double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace rayfarm
