// Films: width, height (u32 little-endian), then for each tile its pass set (a byte) and, if that is not
// empty, the size (u32) and bytes of its packed pixels, coarse passes first.
#include <cstring>

#include "common/net/compress.h"
#include "common/net/little_endian.h"

namespace rayfarm {
namespace {

std::size_t floats_of(const Tile& tile, PassSet passes) {
  std::size_t floats = 0;
  for (int pass = 0; pass < pass_count; ++pass)
    if (passes >> pass & 1) floats += std::size_t{3} * pixel_count(tile, pass);
  return floats;
}

/// Takes the first `size` bytes off the view.
ByteView take(ByteView& bytes, std::size_t size) {
  if (bytes.size() < size) throw CodecError("the film ends too early");
  const ByteView taken = bytes.first(size);
  bytes = bytes.subspan(size);
  return taken;
}

Size take_size(ByteView& bytes) {
  const Size size{read_u32(take(bytes, 4)), read_u32(take(bytes, 4))};
  if (size.width == 0 || size.height == 0 || size.width > max_side || size.height > max_side ||
      std::uint64_t{size.width} * size.height > max_pixels)
    throw CodecError("a film of " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                     " cannot be");
  return size;
}

void put_tile(Film& film, std::uint32_t number, PassSet passes, std::span<const float> floats) {
  const Tile tile = tile_at(film.size(), number);
  for (int pass = 0; pass < pass_count; ++pass) {
    if (!(passes >> pass & 1)) continue;
    const std::size_t count = std::size_t{3} * pixel_count(tile, pass);
    film.put(number, {pass, {floats.begin(), floats.begin() + static_cast<std::ptrdiff_t>(count)}, {}});
    floats = floats.subspan(count);
  }
}

}  // namespace

Bytes encode_film(const Film& film) {
  Bytes out;
  append_u32(out, film.size().width);
  append_u32(out, film.size().height);
  for (std::uint32_t number = 0; number < tile_count(film.size()); ++number) {
    const PassSet passes = film.passes_of(number);
    out.push_back(passes);
    if (passes == 0) continue;
    std::vector<float> floats;
    for (int pass = 0; pass < pass_count; ++pass)
      if (passes >> pass & 1) {
        const std::vector<float> pixels = film.pass_pixels(number, pass);
        floats.insert(floats.end(), pixels.begin(), pixels.end());
      }
    Bytes packed;
    pack_floats(floats, packed);
    append_u32(out, static_cast<std::uint32_t>(packed.size()));
    out.insert(out.end(), packed.begin(), packed.end());
  }
  return out;
}

Film decode_film(ByteView bytes) {
  const Size size = take_size(bytes);
  if (bytes.size() < tile_count(size)) throw CodecError("the film ends too early");
  Film film(size);
  for (std::uint32_t number = 0; number < tile_count(size); ++number) {
    const PassSet passes = take(bytes, 1).front();
    if (passes > all_passes) throw CodecError("a tile of the film has passes that do not exist");
    if (passes == 0) continue;
    const ByteView packed = take(bytes, read_u32(take(bytes, 4)));
    put_tile(film, number, passes, unpack_floats(packed, floats_of(tile_at(size, number), passes)));
  }
  if (!bytes.empty()) throw CodecError("the film is followed by something else");
  return film;
}

}  // namespace rayfarm
