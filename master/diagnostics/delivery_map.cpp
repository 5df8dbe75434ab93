#include "master/diagnostics/delivery_map.h"

#include <cmath>

#include "master/diagnostics/growing_map.h"

namespace rayfarm {
namespace {

std::uint64_t pixels_there(const Tile& area, PassSet passes) {
  std::uint64_t pixels = 0;
  for (int pass = 0; pass < pass_count; ++pass)
    if (passes >> pass & 1) pixels += pixel_count(area, pass);
  return pixels;
}

/// The value of each pass's pixels, if they are there.
std::array<float, pass_count> pass_values(const Deliveries::Tile& tile, const Tile& area,
                                          const MapKind& kind) {
  std::array<float, pass_count> values{};
  if (kind.source == MapSource::farm)
    std::copy(tile.by.begin(), tile.by.end(), values.begin());
  else if (tile.passes != 0)
    values.fill(static_cast<float>(std::chrono::duration<double>(tile.taken).count() /
                                   static_cast<double>(pixels_there(area, tile.passes))));
  return values;
}

/// Calls visit(pass, value) for the passes that are there.
template <class Visit>
void for_each_pass(const Deliveries::Tile& tile, const Tile& area, const MapKind& kind, Visit&& visit) {
  const std::array<float, pass_count> values = pass_values(tile, area, kind);
  for (int pass = 0; pass < pass_count; ++pass)
    if (tile.passes >> pass & 1) visit(pass, values[pass]);
}

/// All pixels of the tile, row by row.
std::vector<float> tile_values(const Deliveries::Tile& tile, const Tile& area, const MapKind& kind) {
  const std::size_t width = area.x1 - area.x0;
  std::vector<float> all(width * (area.y1 - area.y0));
  for_each_pass(tile, area, kind, [&](int pass, float value) {
    for_each_pixel(area, pass, [&](std::uint32_t x, std::uint32_t y) {
      all[(y - area.y0) * width + (x - area.x0)] = value;
    });
  });
  return all;
}

}  // namespace

bool is_of_deliveries(const MapKind& kind) {
  return kind.source == MapSource::farm || kind.source == MapSource::time;
}

LayerNews delivery_news(const Deliveries& deliveries, Size size, const MapKind& kind,
                        const std::vector<std::uint32_t>& order, const std::vector<PassSet>& known,
                        std::uint32_t most_tiles) {
  LayerNews news;
  news.state.size = size;
  news.losses = deliveries.losses, news.is_final = deliveries.is_final;
  if (kind.source == MapSource::farm) news.state.labels = deliveries.names;
  std::vector<PassSet> done;
  std::uint64_t pixels_done = 0;
  for (const Deliveries::Tile& tile : deliveries.tiles) {
    const Tile area = tile_at(size, static_cast<std::uint32_t>(done.size()));
    done.push_back(tile.passes);
    pixels_done += pixels_there(area, tile.passes);
    for_each_pass(tile, area, kind, [&](int, float value) { widen(news.state.range, {&value, 1}); });
  }
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  news.state.share_done = static_cast<double>(pixels_done) / static_cast<double>(pixels);
  if (pixels_done == pixels) news.state.state = LayerProgress::done;
  for (const std::uint32_t number : tiles_with_news(order, done, known, most_tiles))
    news.tiles.push_back(
        {number, done[number], tile_values(deliveries.tiles[number], tile_at(size, number), kind)});
  return news;
}

Map delivery_map(const Deliveries& deliveries, Size size, const MapKind& kind) {
  Map map{size, 1, std::vector<float>(std::size_t{size.width} * size.height, INFINITY)};
  for (std::uint32_t number = 0; number < deliveries.tiles.size(); ++number) {
    const Tile area = tile_at(size, number);
    for_each_pass(deliveries.tiles[number], area, kind, [&](int pass, float value) {
      for_each_pixel(area, pass, [&](std::uint32_t x, std::uint32_t y) {
        map.values[std::size_t{y} * size.width + x] = value;
      });
    });
  }
  return map;
}

}  // namespace rayfarm
