// The journal's rows as bytes, sealed: what was written there, or nothing.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/net/codec.h"
#include "master/farm_record.h"

namespace rayfarm {

/// What a seal is for: a row that comes up in another's place is no row.
struct RowKey {
  std::uint64_t job = 0, frame = 0, number = 0;
};

/// The bytes, and after them the CRC-32 of key and bytes.
Bytes seal(Bytes bytes, const RowKey& key);
/// Nothing when they are not what was sealed under this key.
std::optional<ByteView> unseal(ByteView sealed, const RowKey& key);

// These throw CodecError for what they cannot read.
Bytes encode_row(const JobAdded& job);
Bytes encode_row(const JobChanged& job);
JobAdded decode_job(JobId id, ByteView bytes);
JobChanged decode_change(JobId id, ByteView bytes);

struct FrameRow {
  std::string scene_hash;
  std::vector<std::string> assets;
};
Bytes encode_row(const FrameRow& frame);
FrameRow decode_frame(ByteView bytes);

Bytes encode_row(const PictureDropped& dropped);
PictureDropped decode_dropped(FrameId id, ByteView bytes);

/// Without its pixels; workers by number.
Bytes encode_row(const TileCommitted& commit, std::uint64_t worker, std::span<const std::uint64_t> helpers);
struct TileRow {
  TileCommitted commit;  // without the workers' names
  std::uint64_t worker = 0;
  std::vector<std::uint64_t> helpers;
};
TileRow decode_tile(FrameId id, ByteView bytes);

/// The pixels of a commit, passes from coarse to fine.
Bytes pack_pixels(const TileCommitted& commit);
/// Gives them back to their commit. Throws CodecError unless that lies in the film, and they are as many as it has.
void unpack_pixels(ByteView bytes, Size film, TileCommitted& commit);

}  // namespace rayfarm
