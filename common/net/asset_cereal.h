// The fields of assets, in the order in which they travel.
#pragma once
#include "common/net/cereal_io.h"
#include "common/scene/asset.h"

namespace rayfarm {

/// Many plain values: read in chunks, so that memory follows what has come, whatever length was announced. The bytes are
/// as on all PCs of the farm (x86-64).
template <class Archive, class T>
void plain_values(Archive& archive, std::vector<T>& values) {
  constexpr std::size_t chunk = std::size_t{1} << 16;
  auto count = static_cast<std::uint32_t>(values.size());
  archive(count);
  if constexpr (is_loading<Archive>) values.clear();
  for (std::size_t done = 0; done < count; done += chunk) {
    const std::size_t now = std::min<std::size_t>(chunk, count - done);
    if constexpr (is_loading<Archive>) values.resize(done + now);
    archive(cereal::binary_data(values.data() + done, now * sizeof(T)));
  }
}

template <class Archive>
void serialize(Archive& archive, TriangleMesh& m) {
  plain_values(archive, m.points);
  plain_values(archive, m.triangles);
  plain_values(archive, m.normals);
  plain_values(archive, m.normals_at);
  plain_values(archive, m.texture);
  plain_values(archive, m.texture_at);
}
template <class Archive>
void serialize(Archive& archive, BezierGrid& g) {
  archive(g.rows, g.columns);
  plain_values(archive, g.points);
}
template <class Archive>
void serialize(Archive& archive, Image& i) {
  bool is_linear = i.values.index() == 1;
  archive(i.width, i.height);
  boolean(archive, is_linear);
  if constexpr (is_loading<Archive>)
    if (is_linear) i.values = std::vector<float>{};
  std::visit([&](auto& values) { plain_values(archive, values); }, i.values);
}

}  // namespace rayfarm
