#include "master/split.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace rayfarm {
namespace {

constexpr double hardly_anything = 0.01;  // seconds
constexpr double shortest_piece = 0.005;  // seconds: on its way it takes one or two thousandths

constexpr std::array<std::uint32_t, 3> counts{1, 4, 16};

/// Half of it, or a quarter.
std::uint32_t side_of(std::uint32_t pieces) { return pieces == 16 ? tile_side / 4 : tile_side / 2; }

/// Until so many threads have rendered so many tiles, as a multiple of what one takes of one.
double rounds(std::size_t tiles, std::uint32_t pieces, std::uint32_t threads) {
  const std::size_t all = tiles * pieces;
  return static_cast<double>((all + threads - 1) / threads) / pieces;
}

PassImage assembled_pass(const Tile& tile, std::span<const Tile> pieces,
                         std::span<const std::vector<PassImage>> images, std::size_t place) {
  PassImage whole{images.front()[place].pass, {}, {}};
  std::vector<float> rgb(std::size_t{3} * tile_side * tile_side);
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    return &rgb[3 * (std::size_t{y - tile.y0} * tile_side + (x - tile.x0))];
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const PassImage& part = images[i][place];
    assert(part.pass == whole.pass && "all pieces bring the same passes");
    const float* value = part.rgb.data();
    for_each_pixel(pieces[i], part.pass, [&](std::uint32_t x, std::uint32_t y) {
      std::copy_n(value, 3, at(x, y));
      value += 3;
    });
    whole.counters += part.counters;
  }
  for_each_pixel(tile, whole.pass, [&](std::uint32_t x, std::uint32_t y) {
    const float* value = at(x, y);
    whole.rgb.insert(whole.rgb.end(), value, value + 3);
  });
  return whole;
}

}  // namespace

std::uint32_t pieces_each(std::size_t tiles, std::uint32_t threads) {
  return *std::ranges::min_element(counts, {},
                                   [&](std::uint32_t pieces) { return rounds(tiles, pieces, threads); });
}

std::vector<Tile> pieces_of(const Tile& tile, std::uint32_t count) {
  if (count == 1) return {tile};
  const std::uint32_t side = side_of(count);
  std::vector<Tile> pieces;
  for (std::uint32_t y = tile.y0; y < tile.y1; y += side)
    for (std::uint32_t x = tile.x0; x < tile.x1; x += side)
      pieces.push_back({x, y, std::min(x + side, tile.x1), std::min(y + side, tile.y1)});
  return pieces;
}

std::vector<PassImage> assembled(const Tile& tile, std::span<const Tile> pieces,
                                 std::span<const std::vector<PassImage>> images) {
  std::vector<PassImage> whole;
  for (std::size_t place = 0; place < images.front().size(); ++place)
    whole.push_back(assembled_pass(tile, pieces, images, place));
  return whole;
}

bool is_hardly_begun(const Straggler& straggler) {
  return !straggler.spent || *straggler.spent < hardly_anything;
}

std::vector<Share> shares_of(std::span<const Straggler> stragglers, std::span<const IdleWorker> idle) {
  std::uint32_t threads = 0;
  double speed = 0;
  for (const IdleWorker& worker : idle) threads += worker.threads, speed += worker.threads * worker.speed;
  if (threads == 0) return {};
  speed /= threads;

  std::vector<std::size_t> chosen;
  double ahead = 0;  // seconds that all threads together need for those chosen
  for (const std::size_t place : latest_first(stragglers)) {
    const Straggler& straggler = stragglers[place];
    if (ahead >= straggler.time_left) break;
    const std::uint32_t freed = is_hardly_begun(straggler) && straggler.spent ? 1 : 0;
    const double seconds = ahead + expected_seconds(straggler.cost, speed) / (threads + freed);
    if (seconds >= straggler.time_left) continue;
    ahead = seconds, threads += freed;
    chosen.push_back(place);
  }
  std::vector<Share> shares;
  for (const std::size_t place : chosen) {
    const double seconds = expected_seconds(stragglers[place].cost, speed);
    std::uint32_t pieces = pieces_each(chosen.size(), threads);
    while (pieces > 1 && seconds < pieces * shortest_piece) pieces /= 4;
    if (pieces > 1) shares.push_back({place, pieces});
  }
  return shares;
}

}  // namespace rayfarm
