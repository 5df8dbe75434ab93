// Where a pixel's samples lie: on the pixel and on lights. Counter-based: every number is a function of
// (seed, frame, pixel, sample, dimension pair), so samples can be made in any order, anywhere, again.
//
// sobol: the (0,2) sequence of Sobol', Owen-scrambled by hashing and shuffled per pair of dimensions.
//   Sources: B. Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020; the hash as improved by N.
//   Vegdahl, Building a Better LK Hash, 2021.
// jitter: one sample at random in each of n x n cells. regular: the cells' middles. random: independent.
//   On lights the cells are dealt in a random order of each pixel's own.
//   Source of the permutation: A. Kensler, Correlated Multi-Jittered Sampling, Pixar 13-01, 2013.
// adapt1: independent, a sample for each cell of a quadtree: see adapt1.h.
#pragma once
#include <cstdint>

#include "common/render/settings.h"
#include "common/render/tile.h"

namespace rayfarm {

struct Sample2D {
  double u = 0, v = 0;  // 0 <= u, v < 1
};

/// Pair 0 is the place on the pixel, pair 1 + i the place on light i. For adapt1 the index is a cell's number and
/// pair 0 the place in the cell.
class PixelSampler {
 public:
  PixelSampler(const RenderSettings& settings, Pixel pixel);
  Sample2D sample(std::uint32_t index, std::uint32_t pair) const;

 private:
  SamplerKind kind_;
  std::uint32_t spp_, side_;  // side: cells along one axis
  std::uint64_t key_;
};

}  // namespace rayfarm
