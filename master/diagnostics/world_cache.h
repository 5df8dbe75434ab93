// The scenes that people look into, made ready for rays.
#pragma once
#include <cstdint>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "common/net/messages.h"
#include "common/render/world.h"

namespace rayfarm {

class ReadyScene {
 public:
  explicit ReadyScene(Scene scene) : world_(std::move(scene)) {}

  const World& world() const { return world_; }
  /// What people call the leaves, by number; made at the first question.
  const std::vector<std::string>& leaf_names() const;

 private:
  World world_;
  mutable std::once_flag named_;
  mutable std::vector<std::string> names_;
};

/// About what it takes in memory.
std::uint64_t bytes_of(const World& world);

/// From any thread. Each world is built once for all who ask meanwhile, by the first of them.
class WorldCache {
 public:
  struct Limits {
    std::size_t worlds = 4;
    std::uint64_t bytes = std::uint64_t{2} << 30;  // of those that nobody uses; the newest stays, however big
  };
  explicit WorldCache(Limits limits) : limits_(limits) {}

  /// The assets are those that the scene shows. Throws what the decoding throws.
  std::shared_ptr<const ReadyScene> get(const SceneData& scene, std::span<const AssetData> assets = {});

 private:
  using Future = std::shared_future<std::shared_ptr<const ReadyScene>>;
  struct Entry {
    std::string hash;
    Future scene;
    std::uint64_t bytes = 0;  // 0 while it is being built
  };

  std::list<Entry>::iterator find(const std::string& hash);
  std::shared_ptr<const ReadyScene> build(const SceneData& scene, std::span<const AssetData> assets,
                                          std::promise<std::shared_ptr<const ReadyScene>> promise);
  Asset asset_of(const AssetData& data);
  void drop_old();

  const Limits limits_;
  std::mutex mutex_;          // guards what follows
  std::list<Entry> entries_;  // the one asked for last first
};

}  // namespace rayfarm
