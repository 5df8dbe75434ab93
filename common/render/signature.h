// What a sample's rays met, as one number: by it adaptive sampling tells surfaces apart that have the same colour.
#pragma once
#include "common/math/hash.h"
#include "common/render/observer.h"
#include "common/render/world_parts.h"

namespace rayfarm {

/// A hash of all that the rays of one sample met, in the order of the tree: solids, squares of checkers, the lights
/// and glow shells that added something.
class Signature : public IdleObserver {
 public:
  explicit Signature(const World::Parts& world) : world_(world) {}

  void traced(RayKind kind, const Ray& ray, std::uint32_t, double, const std::optional<Hit>& hit) {
    add(static_cast<std::uint64_t>(kind));
    if (!hit) return;
    add(hit->leaf);
    if (world_.surfaces[hit->leaf].textures > 0) add(texture_cells(world_, ray, *hit));
  }
  void lit(std::size_t light, const SampledLight&, const Vec3d& color) {
    if (color != Vec3d{}) add(light);
  }
  void glowed(std::size_t glow, const Vec3d&) { add(glow); }
  std::uint64_t value() const { return value_; }

 private:
  void add(std::uint64_t number) { value_ = keyed(value_, number); }

  const World::Parts& world_;
  std::uint64_t value_ = 0;
};

}  // namespace rayfarm
