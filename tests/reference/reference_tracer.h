// The reference tracer: one sample at a time, by linear recursion over the tree, written from the description
// of the original and from nothing of ours. It keeps the original's picture and leaves out its numerical
// faults: rays along a cylinder's axis or a plane's face are decided rightly, a secondary ray leaves the surface it
// starts on by rounding of the coordinates, not by a fixed length, and a glow shell changes no ray.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "common/scene/scene.h"
#include "tests/reference/reference_spans.h"

namespace rayfarm {

struct ReferenceHit {
  double distance = 0;
  glm::dvec3 point{0.0}, normal{0.0};  // the normal points out of the material
  int leaf = 0;                        // preorder number among the leaves
};

struct ReferenceSample {
  std::optional<ReferenceHit> first_hit;
  glm::dvec3 color{0.0};
};

struct ReferenceSettings {
  double width = 640, height = 480;  // of the film, pixels
  int max_depth = 12;                // a primary ray has depth 0
  double min_importance = 0.05;
  bool shadows = true, reflections = true, refractions = true;
  glm::dvec2 light_uv{0.5, 0.5};  // the point of every rectangle light
};

/// A scene with its leaves laid out. Keeps a reference to the scene.
class ReferenceTracer {
 public:
  explicit ReferenceTracer(const Scene& scene, const reference::Rules& rules = {})
      : scene_(scene),
        rules_(rules),
        leaves_(reference::leaves_of(scene)),
        glows_(reference::glows_of(scene)) {}

  /// The sample at (x, y) on the film: x to the right, y down, pixel centres at halves.
  ReferenceSample sample(const ReferenceSettings& settings, double x, double y) const;
  /// The first hit of a ray from anywhere, its distance in units of the direction's length.
  std::optional<ReferenceHit> first_hit(const glm::dvec3& origin, const glm::dvec3& direction) const;

 private:
  const Scene& scene_;
  reference::Rules rules_;
  std::vector<reference::Leaf> leaves_;
  std::vector<reference::PlacedGlow> glows_;
};

}  // namespace rayfarm
