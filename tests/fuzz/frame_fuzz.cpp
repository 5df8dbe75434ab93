// What comes over a farm's connection: frames, one behind the other, as master and worker read them.
#include "tests/fuzz/frames.h"

namespace rayfarm {
namespace {

/// Reads the first frame with these functions. Throws CodecError.
template <class DecodeHeader, class DecodePayload>
ByteView after_first_frame(ByteView stream, DecodeHeader decode_header, DecodePayload decode_payload) {
  const FrameHeader header = decode_header(header_of(stream));
  stream = stream.subspan(frame_header_size);
  if (header.size > stream.size()) return {};
  decode_payload(header, stream.first(header.size));
  return stream.subspan(header.size);
}

template <class DecodeHeader, class DecodePayload>
void read_all(ByteView stream, DecodeHeader decode_header, DecodePayload decode_payload) try {
  while (stream.size() >= frame_header_size)
    stream = after_first_frame(stream, decode_header, decode_payload);
} catch (const CodecError&) {}

}  // namespace

void fuzz(ByteView bytes) {
  read_all(bytes, decode_frame_header_to_master, decode_to_master);
  read_all(bytes, decode_frame_header_to_worker, decode_to_worker);
}

}  // namespace rayfarm
