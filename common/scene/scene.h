// What a picture shows, as one value: the CSG tree with its surfaces, the camera, the lights.
// A Scene is all that travels (to the master, to workers, to disk); each side builds its World from it.
//
// Space: world is x right, y up; colours are linear Rec. 709 RGB, unbounded; lengths are the scene's own unit.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "common/geometry/solid.h"
#include "common/math/affine.h"

namespace rayfarm {

// Surfaces.

/// Phong's model with Schlick's factor. Weights are >= 0.
struct Material {
  glm::dvec3 color{1.0, 0.9, 0.4};
  double ambient = 0.2, diffuse = 0.7, specular = 0.2;
  std::uint32_t exponent = 16;
  double transmission = 0;
  double index = 1.5;  // of refraction, > 0
  double schlick = 1;  // 0 switches the grazing-angle factor off
  bool operator==(const Material&) const = default;
};

/// Cell (floor(u * fu) + floor(v * fv)); odd cells show `color`, even ones keep what was there.
struct Checker {
  double fu = 1, fv = 1;
  glm::dvec3 color{1.0};
  bool operator==(const Checker&) const = default;
};
using Texture = std::variant<Checker>;

// The tree.

/// An inner node: its `children` subtrees follow it in preorder; they are combined from left to right.
struct Operation {
  CsgOp op = CsgOp::unite;
  std::uint32_t children = 0;
  bool operator==(const Operation&) const = default;
};

struct Node {
  std::variant<Operation, Solid> content;
  Affine parent_from_node;
  std::optional<std::uint32_t> material;  // index into Scene::materials; inherited by what is below
  std::optional<glm::dvec3> color;  // stands above any material's colour, also above one set further down
  std::vector<Texture> textures;    // those of ancestors come first
  std::string name;
  bool operator==(const Node&) const = default;
};

// Cameras and lights.

struct PerspectiveCamera {
  glm::dvec3 from{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};  // any length > 0
  glm::dvec3 up{0.0, 1.0, 0.0};
  double angle_deg = 50;  // horizontal, full, 0 < angle < 180
  bool operator==(const PerspectiveCamera&) const = default;
};
using Camera = std::variant<PerspectiveCamera>;

struct AmbientLight {
  glm::dvec3 intensity{1.0};
  bool operator==(const AmbientLight&) const = default;
};
struct PointLight {  // no attenuation with distance
  glm::dvec3 at{0.0};
  glm::dvec3 intensity{1.0};
  bool operator==(const PointLight&) const = default;
};
/// Corner `at`, edges `width` and `height`; one point of it per primary sample. Intensity at distance s is
/// intensity / (dim[0] + dim[1] s + dim[2] s^2).
struct RectangleLight {
  glm::dvec3 at{0.0}, width{1.0, 0.0, 0.0}, height{0.0, 1.0, 0.0};
  glm::dvec3 intensity{1.0};
  glm::dvec3 dim{0.5, 1.0, 0.1};
  bool operator==(const RectangleLight&) const = default;
};
using Light = std::variant<AmbientLight, PointLight, RectangleLight>;

// The whole.

/// What the scene asks for; the command line stands above it, the built-in default below.
struct ImageDefaults {
  std::optional<std::uint32_t> width, height, spp;
  bool operator==(const ImageDefaults&) const = default;
};
struct Animation {
  double start = 0, stop = 0, fps = 25;  // seconds; frame N shows start + N / fps
  bool operator==(const Animation&) const = default;
};

struct Scene {
  std::vector<Node> nodes;  // the tree in preorder; nodes[0] is the root
  std::vector<Material> materials;
  Camera camera;
  glm::dvec3 background{0.0, 0.02, 0.03};
  std::vector<Light> lights;
  ImageDefaults image;
  std::optional<Animation> animation;
  bool operator==(const Scene&) const = default;
};

/// A scene (or script) that cannot be used. The message names the place and the fix.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

constexpr std::size_t max_nodes = 8'000'000;
constexpr std::uint32_t max_tree_depth = 256;
constexpr std::size_t max_lights = 1024;
constexpr std::size_t max_textures = 16;  // of one node

/// Throws SceneError unless the scene can be rendered: the tree closes, indices are in range, numbers are
/// finite and in range, every leaf's transform can be inverted, the camera looks somewhere.
void check(const Scene& scene);

}  // namespace rayfarm
