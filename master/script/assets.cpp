#include "master/script/assets.h"

namespace rayfarm {

std::uint32_t Assets::add(AssetContent content) {
  AssetData data = asset_data(content);
  const auto [known, is_new] = by_digest_.try_emplace(data.hash, static_cast<std::uint32_t>(assets_.size()));
  if (is_new) {
    if (data.bytes->size() > max_asset_bytes)
      throw SceneError("takes more than " + std::to_string(max_asset_bytes >> 20) + " MB");
    assets_.emplace_back(data.hash, std::move(content));
    data_.push_back(std::move(data));
  }
  return known->second;
}

const std::uint32_t* Assets::of_file(const std::string& file) const {
  const auto known = by_file_.find(file);
  return known == by_file_.end() ? nullptr : &known->second;
}

std::uint32_t Assets::add_file(const std::string& file, AssetContent content) {
  return by_file_[file] = add(std::move(content));
}

}  // namespace rayfarm
