// The fields of the messages, in the order in which they travel, and what makes their values sane.
// SceneData's and AssetData's bytes and Result's pixels follow after the fields: see frames.cpp.
#pragma once
#include <cmath>

#include "common/net/cereal_io.h"
#include "common/net/messages.h"

namespace rayfarm {

constexpr std::size_t max_hash = 64;  // SHA-256 in hexadecimal

template <class Archive>
void hash_text(Archive& archive, std::string& value) {
  text(archive, value, max_hash);
  if (value.size() != max_hash || value.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw CodecError("a hash must be 64 hexadecimal digits");
}

template <class Archive>
void hash_texts(Archive& archive, std::vector<std::string>& values, std::size_t most) {
  auto count = static_cast<std::uint32_t>(values.size());
  archive(count);
  if (count > most) throw CodecError(std::to_string(count) + " hashes are too many");
  if constexpr (is_loading<Archive>) values.resize(count);
  for (std::string& value : values) hash_text(archive, value);
}

constexpr std::size_t max_certificate = 4096;  // bytes of a certificate or of a request for one

template <class Archive>
void bytes(Archive& archive, std::vector<std::uint8_t>& value, std::size_t limit) {
  auto size = static_cast<std::uint32_t>(value.size());
  archive(size);
  if (size > limit) throw CodecError(std::to_string(size) + " bytes are more than " + std::to_string(limit));
  if constexpr (is_loading<Archive>) value.resize(size);
  archive(cereal::binary_data(value.data(), size));
}

inline void check_order(const Versions& v) {
  if (v.newest < v.oldest) throw CodecError("what is the newest of its protocols is older than the oldest");
}
template <class Archive>
void serialize(Archive& archive, Versions& v) {
  archive(v.newest, v.oldest, v.capabilities);
  check_order(v);
}

// Hello, Welcome, Join and Refused begin alike in all versions of the protocol, and each version may have more to say at
// the end: whoever comes can be read far enough to be told why it is refused.

/// `newest` stands first, the others at the end: protocols before 4 had no more.
template <class Archive>
void serialize(Archive& archive, Hello& m) {
  archive(m.versions.newest);
  text(archive, m.software, max_name);
  text(archive, m.name, max_name);
  text(archive, m.cpu, max_name);
  archive(m.threads);
  if (m.versions.newest < 4) {
    m.versions.oldest = m.versions.newest, m.versions.capabilities = 0;
    return;
  }
  archive(m.versions.oldest, m.versions.capabilities);
  check_order(m.versions);
  hash_text(archive, m.engine);
  archive(m.process);
}
template <class Archive>
void serialize(Archive& archive, Welcome& m) {
  text(archive, m.name, max_name + 16);  // made unique by a number
  archive(m.versions);
}
template <class Archive>
void serialize(Archive& archive, Join& m) {
  archive(m.versions);
  text(archive, m.software, max_name);
  text(archive, m.secret, max_name);
  text(archive, m.name, max_name);
  bytes(archive, m.request, max_certificate);
}
template <class Archive>
void serialize(Archive& archive, Paired& m) {
  bytes(archive, m.certificate, max_certificate);
}
template <class Archive>
void serialize(Archive& archive, Refused& m) {
  text(archive, m.reason, max_text);
}
template <class Archive>
void serialize(Archive& archive, SceneData& m) {
  hash_text(archive, m.hash);
}
template <class Archive>
void serialize(Archive& archive, AssetData& m) {
  hash_text(archive, m.hash);
}
template <class Archive>
void serialize(Archive& archive, RenderSettings& s) {
  archive(s.width, s.height, s.spp);
  enumeration(archive, s.sampler, last_sampler);
  archive(s.seed, s.frame, s.max_depth, s.min_importance);
  boolean(archive, s.shadows);
  boolean(archive, s.reflections);
  boolean(archive, s.refractions);
  try {
    check(s);
  } catch (const SettingsError& error) {
    throw CodecError(error.what());
  }
}
template <class Archive>
void serialize(Archive& archive, FrameStart& m) {
  archive(m.job);
  hash_text(archive, m.scene_hash);
  archive(m.settings);
  hash_texts(archive, m.assets, max_assets);
}
template <class Archive>
void serialize(Archive& archive, Assignment& m) {
  archive(m.lease, m.job, m.frame, m.tile, m.passes);
  if (m.passes == 0 || m.passes > all_passes)
    throw CodecError("an assignment names no pass, or one that does not exist");
}
template <class Archive>
void serialize(Archive& archive, Tile& t) {
  archive(t.x0, t.y0, t.x1, t.y1);
  if (t.x0 >= t.x1 || t.y0 >= t.y1 || t.x1 - t.x0 > tile_side || t.y1 - t.y0 > tile_side)
    throw CodecError("an area cannot be that of a piece of a tile");
}
template <class Archive>
void serialize(Archive& archive, PieceAssignment& m) {
  archive(m.work, m.area);
}
template <class Archive>
void serialize(Archive& archive, HeldTile& t) {
  archive(t.work);
  boolean(archive, t.is_finished);
}
template <class Archive>
void serialize(Archive& archive, Holds& m) {
  archive(m.tiles);
}
template <class Archive>
void serialize(Archive& archive, Unneeded& m) {
  archive(m.leases);
}
template <class Archive>
void serialize(Archive& archive, Revoke& m) {
  archive(m.leases);
}
template <class Archive>
void serialize(Archive& archive, GiveBack& m) {
  archive(m.leases);
  text(archive, m.reason, max_text);
}
template <class Archive>
void serialize(Archive& archive, FrameEnd& m) {
  archive(m.job, m.frame);
}
template <class Archive>
void serialize(Archive& archive, AssetEnd& m) {
  hash_texts(archive, m.hashes, max_assets);
}
template <class Archive>
void serialize(Archive& archive, Goodbye& m) {
  text(archive, m.reason, max_text);
}
template <class Archive>
void serialize(Archive& archive, RayCounters& c) {
  archive(c.primary, c.reflected, c.refracted, c.shadow, c.primary_hits, c.secondary_hits, c.bad_samples,
          c.lost);
}

/// A Result without its pixels, but with how many there are.
struct ResultHead {
  struct Image {
    std::uint8_t pass = 0;
    std::uint32_t floats = 0;
    RayCounters counters;
  };
  LeaseId lease{};
  JobId job{};
  std::uint32_t frame = 0;
  std::uint32_t tile = 0;
  double seconds = 0;
  std::vector<Image> images;
};
template <class Archive>
void serialize(Archive& archive, ResultHead::Image& i) {
  archive(i.pass, i.floats, i.counters);
}
template <class Archive>
void serialize(Archive& archive, ResultHead& m) {
  archive(m.lease, m.job, m.frame, m.tile, m.seconds, m.images);
  if (!std::isfinite(m.seconds) || m.seconds < 0) throw CodecError("a result took no time that can be");
  std::size_t floats = 0;
  int coarser = -1;
  for (const ResultHead::Image& image : m.images) {
    floats += image.floats;
    if (image.pass >= pass_count || image.pass <= coarser || image.floats % 3 != 0 ||
        floats > 3 * tile_side * tile_side)
      throw CodecError("a result's passes cannot be those of a tile");
    coarser = image.pass;
  }
  if (m.images.empty()) throw CodecError("a result brings no pass");
}

}  // namespace rayfarm
