#include "common/render/sampler.h"

#include <cmath>

#include "common/math/hash.h"

namespace rayfarm {
namespace {

std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Each bit is flipped or not by a hash of the bits below it.
std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Owen's nested scramble, each bit by those above it.
std::uint32_t owen_scrambled(std::uint32_t x, std::uint32_t seed) {
  return reversed(laine_karras(reversed(x), seed));
}

/// The second dimension of the (0,2) sequence, its bits reversed: the index times Pascal's triangle modulo 2. Of
/// that, C(k, j) is odd where k has all bits of j (Lucas), so bit j is the sum of all bits k that do.
std::uint32_t second_reversed(std::uint32_t index) {
  index ^= (index >> 16) & 0x0000ffffu;
  index ^= (index >> 8) & 0x00ff00ffu;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 2) & 0x33333333u;
  return index ^ ((index >> 1) & 0x55555555u);
}

double unit_interval32(std::uint32_t bits) { return bits * 0x1p-32; }

/// Element `i` of a random order of 0 .. n-1.
std::uint32_t permuted(std::uint32_t i, std::uint32_t n, std::uint32_t seed) {
  std::uint32_t w = n - 1;
  w |= w >> 1, w |= w >> 2, w |= w >> 4, w |= w >> 8, w |= w >> 16;
  do {
    i ^= seed, i *= 0xe170893du;
    i ^= seed >> 16;
    i ^= (i & w) >> 4;
    i ^= seed >> 8, i *= 0x0929eb3fu;
    i ^= seed >> 23;
    i ^= (i & w) >> 1, i *= 1u | seed >> 27;
    i *= 0x6935fa69u;
    i ^= (i & w) >> 11, i *= 0x74dcb303u;
    i ^= (i & w) >> 2, i *= 0x9e501cc3u;
    i ^= (i & w) >> 2, i *= 0xc860a3dfu;
    i &= w;
    i ^= i >> 5;
  } while (i >= n);
  return (i + seed) % n;
}

std::uint32_t upper(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }
std::uint32_t lower(std::uint64_t x) { return static_cast<std::uint32_t>(x); }

}  // namespace

PixelSampler::PixelSampler(const RenderSettings& s, Pixel pixel)
    : kind_(s.sampler),
      spp_(s.spp),
      side_(static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(s.spp))))),
      key_(keyed(keyed(keyed(s.seed, s.frame), pixel.x), pixel.y)) {}

Sample2D PixelSampler::sample(std::uint32_t index, std::uint32_t pair) const {
  const std::uint64_t key = keyed(key_, pair);
  if (kind_ == SamplerKind::sobol) {
    const std::uint64_t axes = keyed(key, 0);
    const std::uint32_t i = owen_scrambled(index, lower(key));
    // The first dimension is the reversed index; the scramble reverses what it is given.
    return {unit_interval32(reversed(laine_karras(i, upper(axes)))),
            unit_interval32(reversed(laine_karras(second_reversed(i), lower(axes))))};
  }
  const auto bits = [&](std::uint64_t axis) { return keyed(keyed(key, 1 + index), axis); };
  // With 32 bits the place on the pixel of a place in a cell is exact.
  if (kind_ == SamplerKind::adapt1) return {unit_interval32(upper(bits(0))), unit_interval32(upper(bits(1)))};
  const auto random = [&](std::uint64_t axis) { return unit_interval(bits(axis)); };
  if (kind_ == SamplerKind::random) return {random(0), random(1)};
  const std::uint32_t cell = pair == 0 ? index : permuted(index, spp_, lower(key));
  const bool jitter = kind_ == SamplerKind::jitter;
  // The last cell's sum can round up to the edge, which is the next pixel's.
  const auto place = [&](std::uint32_t at, std::uint64_t axis) {
    const double u = (at + (jitter ? random(axis) : 0.5)) / side_;
    return u < 1 ? u : 1 - 0x1p-53;
  };
  return {place(cell % side_, 0), place(cell / side_, 1)};
}

}  // namespace rayfarm
