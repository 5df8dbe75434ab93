// What of a scene is large: meshes, Bezier surfaces, images.
//
// An asset never changes and is addressed by its content. Scenes that show the same one share it, and what is derived
// from it. A scene's bytes name it only; its own bytes travel by themselves, once.
#pragma once
#include <memory>
#include <string>
#include <variant>

#include "common/geometry/bezier.h"
#include "common/geometry/facets.h"
#include "common/geometry/mesh.h"
#include "common/scene/image.h"

namespace rayfarm {

using AssetContent = std::variant<TriangleMesh, BezierGrid, Image>;

class Asset {
 public:
  Asset() = default;
  /// One whose content is elsewhere.
  explicit Asset(std::string digest);
  /// The digest must be that of the content (codec.h: decode_asset, asset_data).
  Asset(std::string digest, AssetContent content);

  const std::string& digest() const { return digest_; }
  /// Null when the content is elsewhere.
  const AssetContent* content() const;
  /// What rays meet of a mesh or Bezier surface, built at the first call for all that share it; null for an image.
  const Facets* facets() const;

  bool operator==(const Asset& other) const { return digest_ == other.digest_; }

 private:
  struct Shared;
  std::string digest_;
  std::shared_ptr<Shared> shared_;
};

/// What makes the content unusable; empty: nothing.
std::string fault_of(const AssetContent& content);

}  // namespace rayfarm
