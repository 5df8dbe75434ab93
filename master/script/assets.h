// The assets of a scene in the making: meshes and images from files, Bezier surfaces; each content once.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/net/codec.h"

namespace rayfarm {

class Assets {
 public:
  /// The number of the asset with this content.
  std::uint32_t add(AssetContent content);
  /// The number of the asset that add_file() gave this file; none before that.
  const std::uint32_t* of_file(const std::string& file) const;
  std::uint32_t add_file(const std::string& file, AssetContent content);

  const std::vector<Asset>& assets() const { return assets_; }
  std::vector<AssetData> take_data() { return std::move(data_); }

 private:
  std::vector<Asset> assets_;
  std::vector<AssetData> data_;  // the same, as they travel
  std::map<std::string, std::uint32_t> by_file_, by_digest_;
};

}  // namespace rayfarm
