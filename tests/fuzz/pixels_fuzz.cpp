// The pixels of tiles and films, as they travel and are kept.
//
// Laws: packing loses no bit, of NaNs neither; a film that was decoded is encoded to bytes that decode to the same.
#include <cstring>

#include "common/net/compress.h"
#include "common/net/little_endian.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {
namespace {

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

void check_packing(const std::vector<float>& floats) {
  Bytes packed;
  pack_floats(floats, packed);
  require(same_bits(unpack_floats(packed, floats.size()), floats), "packing loses no bit");
}

void unpack(ByteView bytes) try {
  if (bytes.size() < 2) return;
  constexpr std::size_t most = std::size_t{3} * tile_side * tile_side;
  check_packing(unpack_floats(bytes.subspan(2), read_u16(bytes) % (most + 1)));
} catch (const CodecError&) {}

void decode(ByteView bytes) try {
  const Bytes once = encode_film(decode_film(bytes));
  require(encode_film(decode_film(once)) == once, "a film that was sent on is the same film");
} catch (const CodecError&) {}

}  // namespace

void fuzz(ByteView bytes) {
  const std::uint8_t door = take_byte(bytes) % 3;
  if (door == 0) return decode(bytes);
  if (door == 1) return unpack(bytes);
  std::vector<float> floats(bytes.size() / sizeof(float));
  if (!floats.empty()) std::memcpy(floats.data(), bytes.data(), floats.size() * sizeof(float));
  check_packing(floats);
}

}  // namespace rayfarm
