// A map as it comes together, pass after pass of its tiles: written by some threads, looked at by others.
#pragma once
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "master/diagnostics/layer.h"
#include "master/diagnostics/map.h"

namespace rayfarm {

class GrowingMap {
 public:
  GrowingMap(Size size, std::size_t channels);

  bool has(std::uint32_t tile, int pass) const;
  /// The values of the pass in the order of for_each_pixel. One that is there already is the same, and stays.
  void put(std::uint32_t tile, int pass, const std::vector<float>& values);
  /// As a LayerSource gives it; the state is made by others.
  LayerNews news(const std::vector<PassSet>& known, std::uint32_t most_tiles) const;
  /// What is there, as fill() spreads it; infinite where nothing is.
  Map so_far() const;
  /// Once all passes of all tiles are there it no longer changes.
  const Map& whole() const { return map_; }

 private:
  const std::vector<std::uint32_t> order_;  // of tiles, centre first

  mutable std::mutex mutex_;  // guards what follows
  Map map_;
  std::vector<PassSet> done_;  // by tile
  std::uint64_t pixels_done_ = 0;
  std::optional<std::array<double, 2>> range_;
};

/// The numbers of at most so many tiles that have more passes than is known (by tile; empty: nothing), in the
/// order given.
std::vector<std::uint32_t> tiles_with_news(const std::vector<std::uint32_t>& order,
                                           const std::vector<PassSet>& done,
                                           const std::vector<PassSet>& known, std::uint32_t most_tiles);
/// Widens the range by the finite ones of the values.
void widen(std::optional<std::array<double, 2>>& range, std::span<const float> values);

}  // namespace rayfarm
