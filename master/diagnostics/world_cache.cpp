#include "master/diagnostics/world_cache.h"

#include <algorithm>

#include "common/net/codec.h"
#include "common/render/world_parts.h"
#include "master/diagnostics/leaf_names.h"

namespace rayfarm {
namespace {

template <class T>
std::uint64_t bytes_in(const std::vector<T>& items) {
  return items.size() * sizeof(T);
}

}  // namespace

const std::vector<std::string>& ReadyScene::leaf_names() const {
  std::call_once(named_, [this] { names_ = rayfarm::leaf_names(world_.scene()); });
  return names_;
}

namespace {

struct AssetBytes {
  std::uint64_t operator()(const Image& i) const {
    return std::visit([](const auto& values) { return bytes_in(values); }, i.values);
  }
  std::uint64_t operator()(const TriangleMesh& m) const {
    constexpr std::uint64_t facet = 72 + 64;  // corners, and its share of the hierarchy
    return bytes_in(m.points) + bytes_in(m.normals) + bytes_in(m.texture) +
           m.triangles.size() * (facet + 3 * sizeof(IndexTriple));
  }
  std::uint64_t operator()(const BezierGrid& g) const {
    constexpr std::uint64_t pieces = 64 * 500;  // of a patch
    return bytes_in(g.points) + pieces * g.rows * g.columns;
  }
};

}  // namespace

std::uint64_t bytes_of(const World& world) {
  const World::Parts& parts = world.parts();
  constexpr std::uint64_t name = 64;  // of a leaf, with its string
  std::uint64_t assets = 0;
  for (const Asset& asset : parts.scene.assets) assets += std::visit(AssetBytes{}, *asset.content());
  return assets + bytes_in(parts.scene.nodes) + bytes_in(parts.leaves) + bytes_in(parts.placements) +
         bytes_in(parts.surfaces) + bytes_in(parts.materials) + bytes_in(parts.textures) +
         bytes_in(parts.items) + bytes_in(parts.objects) + name * parts.leaves.size();
}

std::shared_ptr<const ReadyScene> WorldCache::get(const SceneData& data, std::span<const AssetData> assets) {
  const std::string& hash = data.hash;
  std::unique_lock lock(mutex_);
  if (const auto known = find(hash); known != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, known);
    const Future scene = known->scene;
    lock.unlock();
    return scene.get();
  }
  std::promise<std::shared_ptr<const ReadyScene>> promise;
  entries_.push_front({hash, promise.get_future().share(), 0});
  drop_old();
  lock.unlock();
  return build(data, assets, std::move(promise));
}

std::list<WorldCache::Entry>::iterator WorldCache::find(const std::string& hash) {
  return std::ranges::find(entries_, hash, &Entry::hash);
}

/// One that another world shows is shared with it.
Asset WorldCache::asset_of(const AssetData& data) {
  std::unique_lock lock(mutex_);
  for (const Entry& entry : entries_) {
    if (entry.bytes == 0) continue;
    const std::vector<Asset>& assets = entry.scene.get()->world().scene().assets;
    const auto same = std::ranges::find(assets, data.hash, &Asset::digest);
    if (same != assets.end()) return *same;
  }
  lock.unlock();
  return decode_asset(data);
}

std::shared_ptr<const ReadyScene> WorldCache::build(const SceneData& data, std::span<const AssetData> assets,
                                                    std::promise<std::shared_ptr<const ReadyScene>> promise) {
  const std::string& hash = data.hash;
  try {
    std::vector<Asset> decoded;
    for (const AssetData& asset : assets) decoded.push_back(asset_of(asset));
    auto scene = std::make_shared<const ReadyScene>(decode_scene(*data.bytes, decoded));
    promise.set_value(scene);
    const std::lock_guard lock(mutex_);
    if (const auto entry = find(hash); entry != entries_.end()) entry->bytes = bytes_of(scene->world());
    drop_old();
    return scene;
  } catch (...) {
    promise.set_exception(std::current_exception());
    const std::lock_guard lock(mutex_);
    entries_.remove_if([&](const Entry& entry) { return entry.hash == hash; });
    throw;
  }
}

void WorldCache::drop_old() {
  std::uint64_t bytes = 0;
  std::size_t kept = 0;
  std::erase_if(entries_, [&](const Entry& entry) {
    bytes += entry.bytes;
    return ++kept > limits_.worlds || (kept > 1 && bytes > limits_.bytes);
  });
}

}  // namespace rayfarm
