#include "master/diagnostics/growing_map.h"

#include <algorithm>
#include <cmath>

namespace rayfarm {

GrowingMap::GrowingMap(Size size, std::size_t channels)
    : order_(centre_first(size)), map_{size, channels, {}}, done_(tile_count(size)) {}

bool GrowingMap::has(std::uint32_t tile, int pass) const {
  const std::lock_guard lock(mutex_);
  return (done_[tile] >> pass & 1) != 0;
}

void GrowingMap::put(std::uint32_t tile, int pass, const std::vector<float>& values) {
  const std::lock_guard lock(mutex_);
  if (done_[tile] >> pass & 1) return;
  const std::size_t width = map_.size.width, channels = map_.channels;
  if (map_.values.empty()) map_.values.resize(width * map_.size.height * channels);  // late: it may be big
  const float* value = values.data();
  for_each_pixel(tile_at(map_.size, tile), pass, [&](std::uint32_t x, std::uint32_t y) {
    std::copy_n(value, channels, &map_.values[(y * width + x) * channels]);
    value += channels;
  });
  done_[tile] |= static_cast<PassSet>(1u << pass);
  pixels_done_ += values.size() / channels;
  widen(range_, values);
}

Map GrowingMap::so_far() const {
  const std::lock_guard lock(mutex_);
  Map map{map_.size, map_.channels, {}};
  map.values.assign(std::size_t{map.size.width} * map.size.height * map.channels, INFINITY);
  for (std::uint32_t number = 0; number < done_.size(); ++number)
    for (int pass = 0; pass < pass_count; ++pass) {
      if (!(done_[number] >> pass & 1)) continue;
      const Tile tile = tile_at(map.size, number);
      for_each_pixel(tile, pass, [&](std::uint32_t x, std::uint32_t y) {
        fill(map, tile, pass, {x, y}, &map_.values[(std::size_t{y} * map.size.width + x) * map.channels]);
      });
    }
  return map;
}

LayerNews GrowingMap::news(const std::vector<PassSet>& known, std::uint32_t most_tiles) const {
  const std::lock_guard lock(mutex_);
  const Size size = map_.size;
  LayerNews news;
  news.state.size = size, news.state.channels = map_.channels, news.state.range = range_;
  news.state.share_done = static_cast<double>(pixels_done_) / (static_cast<double>(size.width) * size.height);
  for (const std::uint32_t number : tiles_with_news(order_, done_, known, most_tiles)) {
    const Tile tile = tile_at(size, number);
    TileNews& one = news.tiles.emplace_back(TileNews{number, done_[number], {}});
    for (std::uint32_t y = tile.y0; y < tile.y1; ++y) {
      const float* row = &map_.values[(std::size_t{y} * size.width + tile.x0) * map_.channels];
      one.values.insert(one.values.end(), row, row + (tile.x1 - tile.x0) * map_.channels);
    }
  }
  return news;
}

std::vector<std::uint32_t> tiles_with_news(const std::vector<std::uint32_t>& order,
                                           const std::vector<PassSet>& done,
                                           const std::vector<PassSet>& known, std::uint32_t most_tiles) {
  std::vector<std::uint32_t> tiles;
  for (const std::uint32_t tile : order) {
    if (tiles.size() == most_tiles) break;
    const unsigned seen = known.empty() ? 0u : known[tile];
    if (done[tile] & ~seen) tiles.push_back(tile);
  }
  return tiles;
}

void widen(std::optional<std::array<double, 2>>& range, std::span<const float> values) {
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    if (!range) range = {value, value};
    (*range)[0] = std::min<double>((*range)[0], value);
    (*range)[1] = std::max<double>((*range)[1], value);
  }
}

}  // namespace rayfarm
