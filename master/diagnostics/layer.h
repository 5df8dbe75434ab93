// What a picture view shows of a job, as it comes together: the picture itself, or a map of it.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/render/tile.h"

namespace rayfarm {

enum class LayerProgress : std::uint8_t { making, done, failed };

struct LayerState {
  Size size;
  std::size_t channels = 1;
  LayerProgress state = LayerProgress::making;
  double share_done = 0;                       // of the pixels, 0 to 1
  std::string message;                         // why it failed
  std::optional<std::array<double, 2>> range;  // least and greatest finite value so far
  std::vector<std::string> labels;             // for the values 0, 1, ... of a map of names
  bool operator==(const LayerState&) const = default;
};

struct TileNews {
  std::uint32_t tile = 0;
  PassSet passes = 0;         // that are there now
  std::vector<float> values;  // of all the tile's pixels, row by row; those not there yet are 0
};

struct LayerNews {
  LayerState state;
  std::vector<TileNews> tiles;
  std::uint32_t losses = 0;  // so often passes were taken back: what was told before of any tile may be wrong
  bool is_final = true;      // none will be taken back
};

/// How it stands, and at most so many of the tiles that have more passes than `known` says, by tile number
/// (empty: none is known); those nearest the centre first. Called again and again from any one thread at a
/// time while somebody looks. Throws ApiError when there is nothing to be seen, now or ever.
using LayerSource = std::function<LayerNews(const std::vector<PassSet>& known, std::uint32_t most_tiles)>;

}  // namespace rayfarm
