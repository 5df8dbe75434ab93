#include "master/journal/rows.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "common/net/compress.h"
#include "common/net/little_endian.h"
#include "common/net/message_cereal.h"

namespace rayfarm {
namespace {

std::uint32_t checksum(ByteView bytes, const RowKey& key) {
  const std::array<std::uint64_t, 3> numbers{key.job, key.frame, key.number};
  const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(numbers.data()), sizeof numbers);
  return static_cast<std::uint32_t>(crc32_z(crc, bytes.data(), bytes.size()));
}

/// Any bytes: what the farm took in is kept as it is.
template <class Archive>
void string(Archive& archive, std::string& value) {
  std::vector<char> bytes(value.begin(), value.end());
  archive(bytes);
  value.assign(bytes.begin(), bytes.end());
}

template <class Archive>
void time(Archive& archive, FarmTime& value) {
  std::int64_t count = value.count();
  archive(count);
  value = FarmTime(count);
}

template <class Archive>
void time(Archive& archive, std::optional<FarmTime>& value) {
  bool is_there = value.has_value();
  boolean(archive, is_there);
  FarmTime there = value.value_or(FarmTime{});
  time(archive, there);
  value = is_there ? std::optional(there) : std::nullopt;
}

template <class Archive>
void strings(Archive& archive, std::vector<std::string>& values) {
  auto count = static_cast<std::uint32_t>(values.size());
  archive(count);
  if constexpr (is_loading<Archive>) values.resize(std::min<std::size_t>(count, max_assets));
  for (std::string& value : values) string(archive, value);
}

}  // namespace

template <class Archive>
void serialize(Archive& archive, FrameRow& row) {
  string(archive, row.scene_hash);
  strings(archive, row.assets);
}

namespace {

struct JobRow {
  JobAdded job;
};
template <class Archive>
void serialize(Archive& archive, JobRow& row) {
  JobSpec& spec = row.job.spec;
  string(archive, spec.name);
  string(archive, spec.output);
  archive(spec.settings);
  FrameRange range = spec.frames.value_or(FrameRange{});
  archive(range.first, range.last, range.step);
  if (range.step == 0 || range.first > range.last || range.count() > max_frames)
    throw CodecError("frames that cannot be");
  spec.frames = range;
  archive(spec.priority);
  boolean(archive, spec.hold);
  string(archive, spec.key);
  std::vector<std::string> parameters;
  for (const auto& [name, value] : spec.parameters) parameters.insert(parameters.end(), {name, value});
  strings(archive, parameters);
  for (std::size_t i = 0; i + 1 < parameters.size(); i += 2)
    spec.parameters[parameters[i]] = parameters[i + 1];
  string(archive, spec.script);
  time(archive, row.job.submitted);
}

/// Follows a JobRow; those that were written by the first versions of rayfarm have none.
struct VerificationRow {
  std::string text;
};
template <class Archive>
void serialize(Archive& archive, VerificationRow& row) {
  string(archive, row.text);
}

struct ChangeRow {
  JobChanged change;
};
template <class Archive>
void serialize(Archive& archive, ChangeRow& row) {
  JobChanged& change = row.change;
  enumeration(archive, change.state, JobState::failed);
  archive(change.priority);
  string(archive, change.message);
  string(archive, change.key);
  archive(change.tiles_given_back);
  time(archive, change.ended);
}

/// Follows a ChangeRow; those that were written by the first versions of rayfarm have none.
struct WasteRow {
  std::uint64_t tiles_doubled = 0, tiles_checked = 0;
  FarmTime time_wasted{};
};
template <class Archive>
void serialize(Archive& archive, WasteRow& row) {
  archive(row.tiles_doubled, row.tiles_checked);
  time(archive, row.time_wasted);
}

/// Follows a WasteRow, where tiles were shared already when it was written.
struct ShareRow {
  std::uint64_t tiles_shared = 0, rays_wasted = 0;
};
template <class Archive>
void serialize(Archive& archive, ShareRow& row) {
  archive(row.tiles_shared, row.rays_wasted);
}

struct DroppedRow {
  PictureDropped dropped;
};
template <class Archive>
void serialize(Archive& archive, DroppedRow& row) {
  archive(row.dropped.pixels_done, row.dropped.counters);
  time(archive, row.dropped.thread_time);
  time(archive, row.dropped.ended);
}

template <class Row>
Bytes encoded(const Row& row) {
  Bytes bytes;
  encode_to(bytes, row);
  return bytes;
}

template <class Row>
Row decoded(ByteView bytes) {
  ByteSource source(bytes);
  return decode_from<Row>(source);
}

/// A tile's row is read at every start: plain numbers, in this order.
using TileNumbers = std::array<std::uint64_t, 13>;  // and after them the helpers'
constexpr std::size_t most_helpers = 15;            // of 16 pieces the last is the worker's

}  // namespace

Bytes seal(Bytes bytes, const RowKey& key) {
  append_u32(bytes, checksum(bytes, key));
  return bytes;
}

std::optional<ByteView> unseal(ByteView sealed, const RowKey& key) {
  if (sealed.size() < 4) return std::nullopt;
  const ByteView bytes = sealed.first(sealed.size() - 4);
  if (read_u32(sealed.last(4)) != checksum(bytes, key)) return std::nullopt;
  return bytes;
}

Bytes encode_row(const JobAdded& job) {
  Bytes bytes = encoded(JobRow{job});
  encode_to(bytes, VerificationRow{text_of(job.spec.verification)});
  return bytes;
}
Bytes encode_row(const JobChanged& job) {
  Bytes bytes = encoded(ChangeRow{job});
  encode_to(bytes, WasteRow{job.tiles_doubled, job.tiles_checked, job.time_wasted});
  encode_to(bytes, ShareRow{job.tiles_shared, job.rays_wasted});
  return bytes;
}
Bytes encode_row(const FrameRow& frame) { return encoded(frame); }
Bytes encode_row(const PictureDropped& dropped) { return encoded(DroppedRow{dropped}); }

JobAdded decode_job(JobId id, ByteView bytes) {
  ByteSource source(bytes);
  JobAdded job = decode_from<JobRow>(source).job;
  job.id = id;
  if (source.rest().empty()) return job;
  try {
    job.spec.verification = parse_verification(decode_from<VerificationRow>(source).text);
  } catch (const SettingsError& error) {
    throw CodecError(error.what());
  }
  return job;
}
JobChanged decode_change(JobId id, ByteView bytes) {
  ByteSource source(bytes);
  JobChanged change = decode_from<ChangeRow>(source).change;
  change.id = id;
  if (source.rest().empty()) return change;
  const WasteRow waste = decode_from<WasteRow>(source);
  change.tiles_doubled = waste.tiles_doubled, change.tiles_checked = waste.tiles_checked;
  change.time_wasted = waste.time_wasted;
  if (source.rest().empty()) return change;
  const ShareRow share = decode_from<ShareRow>(source);
  change.tiles_shared = share.tiles_shared, change.rays_wasted = share.rays_wasted;
  return change;
}
FrameRow decode_frame(ByteView bytes) { return decoded<FrameRow>(bytes); }
PictureDropped decode_dropped(FrameId id, ByteView bytes) {
  PictureDropped dropped = decoded<DroppedRow>(bytes).dropped;
  dropped.id = id;
  return dropped;
}

Bytes encode_row(const TileCommitted& c, std::uint64_t worker, std::span<const std::uint64_t> helpers) {
  const RayCounters& n = c.counters;
  const TileNumbers numbers{c.tile,
                            c.passes,
                            worker,
                            static_cast<std::uint64_t>(c.taken.count()),
                            static_cast<std::uint64_t>(c.at.count()),
                            n.primary,
                            n.reflected,
                            n.refracted,
                            n.shadow,
                            n.primary_hits,
                            n.secondary_hits,
                            n.bad_samples,
                            n.lost};
  Bytes bytes(sizeof numbers + helpers.size_bytes());
  std::memcpy(bytes.data(), numbers.data(), sizeof numbers);
  std::ranges::copy(std::as_bytes(helpers), reinterpret_cast<std::byte*>(bytes.data() + sizeof numbers));
  return bytes;
}

TileRow decode_tile(FrameId id, ByteView bytes) {
  TileNumbers n;
  const std::size_t helpers = (bytes.size() - sizeof n) / sizeof(std::uint64_t);
  if (bytes.size() < sizeof n || bytes.size() % sizeof(std::uint64_t) != 0 || helpers > most_helpers)
    throw CodecError("a tile's row has another size");
  std::memcpy(n.data(), bytes.data(), sizeof n);
  TileRow row;
  row.helpers.resize(helpers);
  std::ranges::copy(bytes.subspan(sizeof n), reinterpret_cast<std::uint8_t*>(row.helpers.data()));
  row.commit.frame = id;
  if (n[0] > UINT32_MAX || n[1] == 0 || n[1] > all_passes)
    throw CodecError("a tile's row has a tile or passes that cannot be");
  row.commit.tile = static_cast<std::uint32_t>(n[0]), row.commit.passes = static_cast<PassSet>(n[1]);
  row.worker = n[2];
  row.commit.taken = FarmTime(static_cast<std::int64_t>(n[3]));
  row.commit.at = FarmTime(static_cast<std::int64_t>(n[4]));
  row.commit.counters = {n[5], n[6], n[7], n[8], n[9], n[10], n[11], n[12]};
  return row;
}

Bytes pack_pixels(const TileCommitted& commit) {
  std::vector<float> floats;
  for (int pass = 0; pass < pass_count; ++pass)
    for (const PassImage& image : commit.images)
      if (image.pass == pass) floats.insert(floats.end(), image.rgb.begin(), image.rgb.end());
  Bytes bytes;
  pack_floats(floats, bytes);
  return bytes;
}

void unpack_pixels(ByteView bytes, Size film, TileCommitted& commit) {
  if (commit.tile >= tile_count(film)) throw CodecError("a tile lies outside its picture");
  const Tile tile = tile_at(film, commit.tile);
  std::size_t count = 0;
  for (int pass = 0; pass < pass_count; ++pass)
    if (commit.passes >> pass & 1) count += std::size_t{3} * pixel_count(tile, pass);
  const std::vector<float> floats = unpack_floats(bytes, count);
  auto next = floats.begin();
  for (int pass = 0; pass < pass_count; ++pass) {
    if (!(commit.passes >> pass & 1)) continue;
    const auto end = next + std::ptrdiff_t{3} * pixel_count(tile, pass);
    commit.images.push_back({pass, {next, end}, {}});
    next = end;
  }
}

}  // namespace rayfarm
