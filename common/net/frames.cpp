#include <zlib.h>

#include <algorithm>
#include <array>

#include "common/net/compress.h"
#include "common/net/little_endian.h"
#include "common/net/message_cereal.h"

namespace rayfarm {
namespace {

constexpr std::array<std::uint8_t, 4> magic{'R', 'Y', 'F', 'M'};
constexpr std::array<std::uint8_t, 2> tls_handshake{0x16, 0x03};  // RFC 8446, 5.1

// The largest payload of each message, in bytes.
template <class Message>
constexpr std::uint32_t payload_limit = 2 * max_text;
template <>
constexpr std::uint32_t payload_limit<SceneData> = 256u << 20;
template <>
constexpr std::uint32_t payload_limit<AssetData> = max_asset_bytes + 4096;
template <>
constexpr std::uint32_t payload_limit<FrameStart> = 1u << 20;  // max_assets hashes
template <>
constexpr std::uint32_t payload_limit<AssetEnd> = 1u << 20;
template <>
constexpr std::uint32_t payload_limit<Result> = tile_side* tile_side * 3 * sizeof(float) +
                                                2048;  // + what zstd adds
template <>
constexpr std::uint32_t payload_limit<PieceResult> = payload_limit<Result>;
template <>
constexpr std::uint32_t payload_limit<GiveBack> = 1u << 20;  // 130,000 leases
template <>
constexpr std::uint32_t payload_limit<Revoke> = 1u << 20;
template <>
constexpr std::uint32_t payload_limit<Holds> = 1u << 20;  // 40,000 tiles
template <>
constexpr std::uint32_t payload_limit<Unneeded> = 1u << 20;

template <class Variant>
struct FrameTypes;
template <class... Messages>
struct FrameTypes<std::variant<Messages...>> {
  static constexpr std::array limits{payload_limit<Messages>...};
};

// Payloads. ------------------------------------------------------------------------------------------------

template <class Message>
SharedBytes write_payload(Bytes& out, const Message& message) {
  encode_to(out, message);
  return nullptr;
}

SharedBytes write_payload(Bytes& out, const SceneData& message) {
  encode_to(out, message);
  return message.bytes;
}

SharedBytes write_payload(Bytes& out, const AssetData& message) {
  encode_to(out, message);
  return message.bytes;
}

SharedBytes write_payload(Bytes& out, const Result& result) {
  ResultHead head{result.lease, result.job, result.frame, result.tile, result.seconds, {}};
  std::vector<float> floats;
  for (const PassImage& image : result.images) {
    head.images.push_back({static_cast<std::uint8_t>(image.pass),
                           static_cast<std::uint32_t>(image.rgb.size()), image.counters});
    floats.insert(floats.end(), image.rgb.begin(), image.rgb.end());
  }
  encode_to(out, head);
  pack_floats(floats, out);
  return nullptr;
}

SharedBytes write_payload(Bytes& out, const PieceResult& piece) {
  encode_to(out, piece.area);
  return write_payload(out, piece.result);
}

void expect_nothing(ByteView rest) {
  if (!rest.empty()) throw CodecError("the message is followed by something else");
}

template <class Message>
void read_payload(ByteView payload, Message& message) {
  ByteSource source(payload);
  message = decode_from<Message>(source);
  expect_nothing(source.rest());
}

/// Of a later version: it may have more to say at the end.
template <class Message>
void read_beginning(ByteView payload, Message& message) {
  ByteSource source(payload);
  message = decode_from<Message>(source);
  if (message.versions.newest <= protocol_version) expect_nothing(source.rest());
}
void read_payload(ByteView payload, Hello& hello) { read_beginning(payload, hello); }
void read_payload(ByteView payload, Join& join) { read_beginning(payload, join); }

template <class Data>  // SceneData, AssetData
void read_data(ByteView payload, Data& message) {
  ByteSource source(payload);
  message = decode_from<Data>(source);
  message.bytes = std::make_shared<const Bytes>(source.rest().begin(), source.rest().end());
}
void read_payload(ByteView payload, SceneData& message) { read_data(payload, message); }
void read_payload(ByteView payload, AssetData& message) { read_data(payload, message); }

void read_result(ByteSource& source, Result& result) {
  const auto head = decode_from<ResultHead>(source);
  std::size_t count = 0;
  for (const ResultHead::Image& image : head.images) count += image.floats;
  const std::vector<float> floats = unpack_floats(source.rest(), count);
  result = {head.lease, head.job, head.frame, head.tile, {}, head.seconds};
  auto at = floats.begin();
  for (const ResultHead::Image& image : head.images) {
    result.images.push_back({image.pass, {at, at + image.floats}, image.counters});
    at += image.floats;
  }
}
void read_payload(ByteView payload, Result& result) {
  ByteSource source(payload);
  read_result(source, result);
}
void read_payload(ByteView payload, PieceResult& piece) {
  ByteSource source(payload);
  piece.area = decode_from<Tile>(source);
  read_result(source, piece.result);
}

// Frames. --------------------------------------------------------------------------------------------------

std::uint32_t crc_of(ByteView bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(crc32_z(before, bytes.data(), bytes.size()));
}

template <class Variant>
Frame make_frame(const Variant& message) {
  Frame frame{Bytes(frame_header_size), nullptr};
  frame.tail = std::visit([&](const auto& m) { return write_payload(frame.head, m); }, message);
  const ByteView fields = ByteView(frame.head).subspan(frame_header_size);
  const ByteView tail = frame.tail ? ByteView(*frame.tail) : ByteView();
  const std::size_t size = fields.size() + tail.size(), limit = FrameTypes<Variant>::limits[message.index()];
  if (size > limit)
    throw CodecError("a message of " + std::to_string(size) + " bytes is over the limit of " +
                     std::to_string(limit));

  Bytes header(magic.begin(), magic.end());
  append_u16(header, frame_version);
  append_u16(header, static_cast<std::uint16_t>(message.index()));
  append_u32(header, static_cast<std::uint32_t>(size));
  append_u32(header, tail.empty() ? crc_of(fields) : crc_of(tail, crc_of(fields)));
  std::ranges::copy(header, frame.head.begin());
  return frame;
}

Bytes whole(Frame frame) {
  if (frame.tail) frame.head.insert(frame.head.end(), frame.tail->begin(), frame.tail->end());
  return std::move(frame.head);
}

template <class Variant>
FrameHeader decode_header(ByteView bytes) {
  if (std::ranges::equal(bytes.first(tls_handshake.size()), tls_handshake))
    throw CodecError("the peer encrypts what it says, and this side has no certificate");
  if (!std::ranges::equal(bytes.first(magic.size()), magic))
    throw CodecError("the peer does not speak rayfarm's protocol");
  const std::uint16_t version = read_u16(bytes.subspan(4));
  if (version != frame_version)
    throw CodecError("the peer's frames have version " + std::to_string(version) + ", ours " +
                     std::to_string(frame_version));
  const FrameHeader header{read_u16(bytes.subspan(6)), read_u32(bytes.subspan(8)),
                           read_u32(bytes.subspan(12))};
  const auto& limits = FrameTypes<Variant>::limits;
  if (header.type >= limits.size())
    throw CodecError("there is no message of type " + std::to_string(header.type));
  if (header.size > limits[header.type])
    throw CodecError("a message of type " + std::to_string(header.type) + " announces " +
                     std::to_string(header.size) + " bytes, the limit is " +
                     std::to_string(limits[header.type]));
  return header;
}

template <class... Messages>
void read_message(std::uint16_t type, ByteView payload, std::variant<Messages...>& message) {
  using Variant = std::variant<Messages...>;
  using Read = void (*)(ByteView, Variant&);
  constexpr std::array<Read, sizeof...(Messages)> reads{
      [](ByteView from, Variant& to) { read_payload(from, to.template emplace<Messages>()); }...};
  if (type >= reads.size()) throw CodecError("there is no message of type " + std::to_string(type));
  reads[type](payload, message);
}

template <class Variant>
Variant decode_payload(const FrameHeader& header, ByteView payload) {
  if (payload.size() != header.size || crc_of(payload) != header.crc)
    throw CodecError("a message of type " + std::to_string(header.type) + " was damaged on its way");
  Variant message;
  read_message(header.type, payload, message);
  return message;
}

}  // namespace

FrameHeader decode_frame_header_to_worker(std::span<const std::uint8_t, frame_header_size> bytes) {
  return decode_header<ToWorker>(bytes);
}
FrameHeader decode_frame_header_to_master(std::span<const std::uint8_t, frame_header_size> bytes) {
  return decode_header<ToMaster>(bytes);
}
ToWorker decode_to_worker(const FrameHeader& header, ByteView payload) {
  return decode_payload<ToWorker>(header, payload);
}
ToMaster decode_to_master(const FrameHeader& header, ByteView payload) {
  return decode_payload<ToMaster>(header, payload);
}
Frame frame_of(const ToWorker& message) { return make_frame(message); }
Frame frame_of(const ToMaster& message) { return make_frame(message); }
Bytes encode(const ToWorker& message) { return whole(make_frame(message)); }
Bytes encode(const ToMaster& message) { return whole(make_frame(message)); }

}  // namespace rayfarm
