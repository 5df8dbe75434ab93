#include "master/http/asset_store.h"

#include <algorithm>

namespace rayfarm {

AssetData AssetStore::add(AssetData asset) {
  const std::lock_guard lock(mutex_);
  std::erase_if(known_, [](const auto& known) { return known.second.expired(); });
  SharedBytes::weak_type& known = known_[asset.hash];
  if (const SharedBytes here = known.lock()) asset.bytes = here;
  known = asset.bytes;
  keep(asset);
  return asset;
}

std::optional<AssetData> AssetStore::find(const std::string& hash) {
  const std::lock_guard lock(mutex_);
  const auto known = known_.find(hash);
  if (known == known_.end()) return std::nullopt;
  AssetData asset{hash, known->second.lock()};
  if (!asset.bytes) return std::nullopt;
  keep(asset);  // who asks is about to submit a job
  return asset;
}

void AssetStore::keep(const AssetData& asset) {
  std::erase_if(kept_, [&](const AssetData& kept) { return kept.hash == asset.hash; });
  kept_.push_back(asset);
  std::uint64_t bytes = 0;
  for (const AssetData& kept : kept_) bytes += kept.bytes->size();
  for (; kept_.size() > 1 && bytes > limit_; kept_.pop_front()) bytes -= kept_.front().bytes->size();
}

}  // namespace rayfarm
