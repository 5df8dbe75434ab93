#include "common/scene/asset.h"

#include <mutex>

#include "common/math/overload.h"

namespace rayfarm {

struct Asset::Shared {
  AssetContent content;
  std::once_flag built;
  std::unique_ptr<const Facets> facets;
};

Asset::Asset(std::string digest) : digest_(std::move(digest)) {}
Asset::Asset(std::string digest, AssetContent content)
    : digest_(std::move(digest)), shared_(std::make_shared<Shared>()) {
  shared_->content = std::move(content);
}

const AssetContent* Asset::content() const { return shared_ ? &shared_->content : nullptr; }

const Facets* Asset::facets() const {
  std::call_once(shared_->built, [&] {
    std::visit(
        Overload{[](const Image&) {}, [&](const auto& surface) { shared_->facets = make_facets(surface); }},
        shared_->content);
  });
  return shared_->facets.get();
}

std::string fault_of(const AssetContent& content) {
  return std::visit([](const auto& c) { return fault_of(c); }, content);
}

}  // namespace rayfarm
