// Adaptive samples on a pixel, as the course's renderer takes them when told sampling=adapt1.
//
// The pixel is the root of a quadtree, with one sample at random in it. A cell that is divided hands its sample to
// the quarter in which it lies; the other three take a new one each, at random. Two quarters side by side differ when
// their samples' signatures differ (see signature.h) or their colours, linear and unclamped, are `threshold` or more
// apart; a quarter that differs from a neighbour is divided. With spp = n * n cells are divided while there are less
// than n along the pixel's side, the root always: a pixel takes 4 to 4^ceil(log2 n) samples, for n = 1 one. Its value
// is the sum of all samples, each weighed by its cell's area.
//
// It is here to be compared with, not to be mended: four samples that agree by chance hide what lies between them,
// and the samples that decide are kept, so small things come out too dark.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/math/vec.h"
#include "common/render/sampler.h"

namespace rayfarm::adapt1 {

constexpr double threshold = 0.004;  // as the course's renderer has it unless told otherwise

/// How often a pixel's side is halved at most.
constexpr std::uint32_t depth(std::uint32_t spp) {
  std::uint32_t halvings = 0;
  while ((std::uint64_t{1} << 2 * halvings) < spp) ++halvings;
  return halvings;
}

/// The smallest cells in a pixel: the unit of weight.
constexpr std::uint32_t smallest_cells(std::uint32_t spp) { return 1u << 2 * depth(spp); }

/// A square of the pixel: one of 2^level along each axis.
struct Cell {
  std::uint32_t level = 0, x = 0, y = 0;

  std::uint32_t number() const { return (1u << 2 * level) + (y << level) + x; }  // no other cell's
  Cell quarter(std::uint32_t q) const { return {level + 1, 2 * x + (q & 1), 2 * y + (q >> 1)}; }
  bool contains(const Sample2D& at) const {
    const double side = 1u << level;
    return static_cast<std::uint32_t>(at.u * side) == x && static_cast<std::uint32_t>(at.v * side) == y;
  }
  /// Exact: a sample in the cell has 32 bits.
  Sample2D on_pixel(const Sample2D& in_cell) const {
    const double side = 1u << level;
    return {(x + in_cell.u) / side, (y + in_cell.v) / side};
  }
};

/// What a sample shows.
struct Seen {
  Vec3d color{};
  std::uint64_t signature = 0;
};

inline bool differ(const Seen& a, const Seen& b) {
  return a.signature != b.signature || length(a.color - b.color) >= threshold;
}

struct Sample {
  Sample2D at;  // on the pixel
  Seen seen;
  std::uint32_t weight = 0;  // in smallest cells
};

/// The samples of one pixel. `take(cell number, place on the pixel)` traces one.
template <class Take>
class Quadtree {
 public:
  Quadtree(const PixelSampler& sampler, std::uint32_t spp, Take take)
      : sampler_(sampler), depth_(depth(spp)), take_(std::move(take)) {
    const Cell pixel;
    const std::uint32_t first = taken_in(pixel);
    if (depth_ == 0)
      weigh(first, pixel);
    else
      divide(pixel, first);
  }
  /// In the order in which they were taken. The weights add up to smallest_cells().
  const std::vector<Sample>& samples() const { return samples_; }

 private:
  std::uint32_t taken_in(const Cell& cell) {
    const Sample2D at = cell.on_pixel(sampler_.sample(cell.number(), 0));
    samples_.push_back({at, take_(cell.number(), at)});
    return static_cast<std::uint32_t>(samples_.size() - 1);
  }
  void weigh(std::uint32_t sample, const Cell& cell) {
    samples_[sample].weight = 1u << 2 * (depth_ - cell.level);
  }
  void divide(const Cell& cell, std::uint32_t sample) {
    std::array<std::uint32_t, 4> in;  // the quarters' samples
    for (std::uint32_t q = 0; q < 4; ++q) {
      const Cell quarter = cell.quarter(q);
      in[q] = quarter.contains(samples_[sample].at) ? sample : taken_in(quarter);
    }
    const auto differs = [&](std::uint32_t q, std::uint32_t neighbour) {
      return differ(samples_[in[q]].seen, samples_[in[neighbour]].seen);
    };
    for (std::uint32_t q = 0; q < 4; ++q) {
      const Cell quarter = cell.quarter(q);
      if (quarter.level < depth_ && (differs(q, q ^ 1) || differs(q, q ^ 2)))
        divide(quarter, in[q]);
      else
        weigh(in[q], quarter);
    }
  }

  const PixelSampler& sampler_;
  const std::uint32_t depth_;
  Take take_;
  std::vector<Sample> samples_;
};

}  // namespace rayfarm::adapt1
