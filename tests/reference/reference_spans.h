// Where a line is inside the scene, computed as literally as the original describes it: every solid's
// crossings over the whole line, merged operator by operator from left to right. Slow, plain, in extended
// precision; it shares nothing with the core but the Scene value, so that the two can be held against each
// other.
#pragma once
#include <optional>
#include <vector>

#include "common/scene/scene.h"
#include "tests/reference/reference_surfaces.h"

namespace rayfarm::reference {

/// A leaf of the tree with all that it inherits.
struct Leaf {
  Solid solid;
  std::optional<Surface> surface;  // of a mesh or Bezier surface
  Mat world_from_local{1};
  Mat local_from_world{1};  // of directions; points are taken relative to `offset` first
  Vec offset{0};
  std::optional<glm::dvec3> color;
  Material material;
  std::vector<Texture> textures;  // ancestors' first
  bool no_shadow = false;
};

struct PlacedGlow {
  Glow glow;
  Leaf leaf;  // where a line is inside it; a tube's is endless
};

/// The leaves in preorder.
std::vector<Leaf> leaves_of(const Scene& scene);
std::vector<PlacedGlow> glows_of(const Scene& scene);

/// How far the crossing lies in front of the ray's origin, measured across its surface.
Real depth_across(const Crossing& crossing, const Ray& ray);

/// A ray that starts on a surface leaves behind what lies less than rounding of the coordinates in front of it.
bool is_ahead(const Crossing& crossing, const Ray& ray);

struct Rules;

/// The spans of each part of the scene, its topmost unions taken apart: also what lies within another part.
std::vector<Spans> spans_of_parts(const Scene& scene, const std::vector<Leaf>& leaves, const Ray& ray,
                                  const Rules& rules);

/// What of the tracer can be had as the original has it (original_rules.h), to show what differs.
struct Rules {
  Spans (*spans)(const Solid&, const Ray& local) = spans_of;
  /// Two surfaces at most this part of their coordinates apart are one: the scene's numbers are doubles, so
  /// coincident faces that come through different transforms differ by some 1e-16.
  Real coincidence = 1e-13L;
  /// Whether a ray that starts on a surface meets the crossing, or leaves it behind.
  bool (*is_ahead)(const Crossing&, const Ray&) = reference::is_ahead;
  Spans (*of_sheet)(const std::vector<Crossing>&, const Ray& local) = spans_of_sheet;
  /// What may block a light, each by itself.
  std::vector<Spans> (*blockers)(const Scene&, const std::vector<Leaf>&, const Ray&,
                                 const Rules&) = spans_of_parts;
};

/// The spans of one leaf in world space.
Spans spans_of(const Leaf& leaf, int number, const Ray& ray, const Rules& rules = {});

/// The spans of the whole tree. Surfaces nearer to each other than rounding of the scene's own numbers count
/// as one.
Spans spans_of(const Scene& scene, const std::vector<Leaf>& leaves, const Ray& ray, const Rules& rules = {});

}  // namespace rayfarm::reference
