#include "master/http/live/tile_message.h"

#include <bit>
#include <cstring>

#include "master/http/live/half.h"

namespace rayfarm {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t head_size = 32;
constexpr std::uint32_t magic = 0x31544652;

template <class Number>
std::uint8_t* put(std::uint8_t* at, Number number) {
  std::memcpy(at, &number, sizeof number);
  return at + sizeof number;
}

std::uint32_t divided(std::uint32_t number, std::uint32_t by) { return (number + by - 1) / by; }

/// The passes that are there together with all coarser ones.
int passes_in_a_row(PassSet passes) { return std::countr_one(passes); }

std::uint8_t* put_head(std::uint8_t* at, const SentLayer& layer, const Tile& tile, std::uint32_t stride,
                       bool is_finished) {
  const std::uint32_t step = layer.step;
  at = put(put(at, magic), layer.id);
  at = put(put(at, tile.x0 / step), tile.y0 / step);
  at = put(put(at, divided(tile.x1 - tile.x0, step)), divided(tile.y1 - tile.y0, step));
  at = put(at, static_cast<std::uint16_t>(stride / step));
  at = put(put(at, static_cast<std::uint8_t>(layer.channels)), static_cast<std::uint8_t>(is_finished));
  return put(at, std::uint32_t{0});
}

}  // namespace

PassSet passes_sent(std::uint32_t step) {
  PassSet passes = 0;
  for (int pass = 0; pass < pass_count; ++pass)
    if (pass_stride[pass] >= step) passes |= static_cast<PassSet>(1u << pass);
  return passes;
}

SharedMessage tile_message(const SentLayer& layer, const TileNews& news) {
  const PassSet sent = passes_sent(layer.step);
  const int complete = passes_in_a_row(news.passes & sent);
  if (complete == 0) return nullptr;
  const bool is_finished = (news.passes & sent) == sent;
  const std::uint32_t stride = pass_stride[complete - 1];
  const Tile tile = tile_at(layer.size, news.tile);
  const std::uint32_t width = tile.x1 - tile.x0, height = tile.y1 - tile.y0;
  const std::size_t numbers = std::size_t{divided(width, stride)} * divided(height, stride) * layer.channels;

  auto message = std::make_shared<std::vector<std::uint8_t>>(head_size + numbers * (is_finished ? 4 : 2));
  std::uint8_t* at = put_head(message->data(), layer, tile, stride, is_finished);
  for (std::uint32_t y = 0; y < height; y += stride)
    for (std::uint32_t x = 0; x < width; x += stride) {
      const float* pixel = &news.values[(std::size_t{y} * width + x) * layer.channels];
      for (std::size_t channel = 0; channel < layer.channels; ++channel)
        at = is_finished ? put(at, pixel[channel]) : put(at, half_of(pixel[channel]));
    }
  return message;
}

}  // namespace rayfarm
