// A scene made ready for rays: leaves with their transforms and error bounds, objects, their bounding
// hierarchy. Derived from Scene on each side; never travels.
#pragma once
#include <memory>

#include "common/scene/scene.h"

namespace rayfarm {

class World {
 public:
  /// The scene must have passed check().
  explicit World(Scene scene);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  const Scene& scene() const;

  struct Parts;  // world_parts.h: for the tracer
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<const Parts> parts_;
};

}  // namespace rayfarm
