// The messages of the conversation, Hello and Join first. The bytes are a frame, whose size and checksum are put right:
// no fuzzer would find them.
//
// Law: what was decoded is encoded to bytes that decode to the same.
#include <zlib.h>

#include <algorithm>

#include "common/net/little_endian.h"
#include "tests/fuzz/frames.h"

namespace rayfarm {
namespace {

Bytes put_right(ByteView frame) {
  const ByteView payload = frame.subspan(frame_header_size);
  Bytes right(frame.begin(), frame.begin() + 8);  // magic, version, type
  append_u32(right, static_cast<std::uint32_t>(payload.size()));
  append_u32(right, static_cast<std::uint32_t>(crc32_z(0, payload.data(), payload.size())));
  right.insert(right.end(), payload.begin(), payload.end());
  return right;
}

/// decode(frame) is a ToMaster or a ToWorker.
template <class Decode>
void check(const Bytes& frame, Decode decode) try {
  const Bytes once = encode(decode(frame));
  require(encode(decode(once)) == once, "a message that was sent on is the same message");
} catch (const CodecError&) {}

}  // namespace

void fuzz(ByteView bytes) {
  if (bytes.size() < frame_header_size) return;
  const Bytes frame = put_right(bytes);
  const auto payload_of = [](ByteView whole) { return whole.subspan(frame_header_size); };
  check(frame, [&](ByteView f) {
    return decode_to_master(decode_frame_header_to_master(header_of(f)), payload_of(f));
  });
  check(frame, [&](ByteView f) {
    return decode_to_worker(decode_frame_header_to_worker(header_of(f)), payload_of(f));
  });
}

}  // namespace rayfarm
