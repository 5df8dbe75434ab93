// The rows of a journal, behind their seals; the first byte says of which table.
//
// Law: a row that was read is written to bytes that are read as the same.
#include "common/net/little_endian.h"
#include "master/journal/rows.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {
namespace {

constexpr FrameId frame{JobId{7}, 3};

template <class Decode, class Encode>
void check(ByteView bytes, Decode decode, Encode encode) try {
  const Bytes once = encode(decode(bytes));
  require(encode(decode(once)) == once, "a row that was kept is the same row");
} catch (const CodecError&) {}

/// A commit, and its pixels.
void check_tile(ByteView bytes) try {
  if (bytes.size() < 2) return;
  const std::size_t size = std::min<std::size_t>(read_u16(bytes), bytes.size() - 2);
  TileRow row = decode_tile(frame, bytes.subspan(2, size));
  unpack_pixels(bytes.subspan(2 + size), {100, 80}, row.commit);
} catch (const CodecError&) {}

}  // namespace

void fuzz(ByteView bytes) {
  const auto encode = [](const auto& row) { return encode_row(row); };
  const std::uint8_t table = take_byte(bytes) % 6;
  if (table == 0)
    check(
        bytes, [](ByteView b) { return decode_job(frame.job, b); }, encode);
  if (table == 1)
    check(
        bytes, [](ByteView b) { return decode_change(frame.job, b); }, encode);
  if (table == 2)
    check(
        bytes, [](ByteView b) { return decode_frame(b); }, encode);
  if (table == 3)
    check(
        bytes, [](ByteView b) { return decode_dropped(frame, b); }, encode);
  if (table == 4)
    check(
        bytes, [](ByteView b) { return decode_tile(frame, b); },
        [](const TileRow& row) { return encode_row(row.commit, row.worker, row.helpers); });
  if (table == 5) check_tile(bytes);
}

}  // namespace rayfarm
