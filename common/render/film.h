// The picture as it comes together: which passes of which tiles are there, and their pixels.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/render/counters.h"
#include "common/render/tile.h"
#include "common/render/zeroed_memory.h"

namespace rayfarm {

/// One pass of one tile as rendered: what travels from a worker and what a film takes in.
struct PassImage {
  int pass = 0;
  std::vector<float> rgb;  // 3 floats a pixel, linear, in the order of for_each_pixel
  RayCounters counters;    // exact, for these pixels alone
  bool operator==(const PassImage&) const = default;
};

class Film {
 public:
  Film() = default;
  explicit Film(Size size);

  Size size() const { return size_; }
  /// Puts a pass in its place. The image must have pixel_count(tile, pass) pixels.
  void put(std::uint32_t tile, const PassImage& image);
  /// The passes are there; they are black, and not there, afterwards.
  void take_out(std::uint32_t tile, PassSet passes);
  PassSet passes_of(std::uint32_t tile) const { return done_[tile]; }
  bool is_complete() const { return pixels_done_ == std::uint64_t{size_.width} * size_.height; }
  std::uint64_t pixels_done() const { return pixels_done_; }
  /// The pixels of one pass again, in travelling order; the pass must be there.
  std::vector<float> pass_pixels(std::uint32_t tile, int pass) const;
  /// Those of them that are in a piece of the tile.
  std::vector<float> pass_pixels(const Tile& piece, int pass) const;
  /// Row-major, width * height * 3, linear Rec. 709; y grows downwards. Pixels not there yet are black.
  const ZeroedVector<float>& rgb() const { return rgb_; }
  /// As rgb(), but a pixel not there yet shows the nearest coarser one up-left of it in its tile, if any.
  std::vector<float> filled() const;

 private:
  Size size_;
  ZeroedVector<float> rgb_;
  std::vector<PassSet> done_;  // by tile number
  std::uint64_t pixels_done_ = 0;
};

}  // namespace rayfarm
