// Values as bytes and back: cereal's portable binary inside, zstd where it pays.
//
// decode(encode(x)) == x, bit for bit. Decoders take any bytes: what is too short, too long, out of range or
// corrupt throws CodecError. A length is never trusted: memory follows the bytes that really came (for a
// scene, those that they decompress to, at most 1 GB; for a film, 48 kB a tile).
#pragma once
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/net/messages.h"
#include "common/render/film.h"
#include "common/scene/scene.h"

namespace rayfarm {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

struct CodecError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Compressed. The same scene always gives the same bytes, so their hash is the scene's address. Of its assets they hold
/// the digests only.
Bytes encode_scene(const Scene& scene);
/// Decoded and passed through check(): what comes back can be rendered. Its assets must be among those given. Throws
/// CodecError or SceneError.
Scene decode_scene(ByteView bytes, std::span<const Asset> assets = {});

constexpr std::size_t max_asset_bytes = 256u << 20;  // encoded

/// Compressed; the same content always gives the same bytes.
AssetData asset_data(const AssetContent& content);
/// Throws CodecError, also when the bytes do not have the hash or the content is unusable.
Asset decode_asset(const AssetData& data);

Bytes encode_film(const Film& film);
Film decode_film(ByteView bytes);

std::string sha256_hex(ByteView bytes);
std::string base64(ByteView bytes);
Bytes from_base64(std::string_view text);

// Frames: 16 bytes (magic "RYFM", version u16, type u16, payload size u32, CRC-32 of the payload u32;
// little-endian), then the payload. The type is the message's index in its variant. The version is that of
// the header and of how Hello, Join, Welcome, Refused and Goodbye begin, which stay, so that any two versions of the
// protocol can tell each other what they are.
constexpr std::uint16_t frame_version = 1;
constexpr std::size_t frame_header_size = 16;

struct FrameHeader {
  std::uint16_t type = 0;
  std::uint32_t size = 0, crc = 0;
};

/// Throws CodecError on a wrong magic, an unknown version or type, or a size over the limit for the type.
FrameHeader decode_frame_header_to_worker(std::span<const std::uint8_t, frame_header_size> bytes);
FrameHeader decode_frame_header_to_master(std::span<const std::uint8_t, frame_header_size> bytes);
/// The payload of a frame; checks the checksum and that the message has sane values.
ToWorker decode_to_worker(const FrameHeader& header, ByteView payload);
ToMaster decode_to_master(const FrameHeader& header, ByteView payload);
/// A frame in two parts: a scene's bytes are shared by all connections that send them. The tail may be null.
struct Frame {
  Bytes head;
  SharedBytes tail;
};
/// Throws CodecError when the other side would not take the message (a text too long, a scene too large).
Frame frame_of(const ToWorker& message);
Frame frame_of(const ToMaster& message);
/// A whole frame, header and payload.
Bytes encode(const ToWorker& message);
Bytes encode(const ToMaster& message);

}  // namespace rayfarm
