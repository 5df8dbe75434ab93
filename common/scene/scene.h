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
#include "common/scene/asset.h"

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
/// Cells as a checker's, each halved along its diagonal: `color` shows where the cell is odd and frac(u * fu) >
/// frac(v * fv), and where neither holds; elsewhere stays what was there.
struct Stripes {
  double fu = 1, fv = 1;
  glm::dvec3 color{1.0};
  bool operator==(const Stripes&) const = default;
};
/// An image over each unit square of (u, v), its lower left corner at (0, 0); repeated fu, fv times in it.
struct ImageTexture {
  std::uint32_t asset = 0;  // index into Scene::assets
  double fu = 1, fv = 1;
  bool smooth = true;  // bilinear between the pixels' middles; else the nearest pixel
  bool operator==(const ImageTexture&) const = default;
};
using Texture = std::variant<Checker, Stripes, ImageTexture>;

// The tree.

/// An inner node: its `children` subtrees follow it in preorder; they are combined from left to right.
struct Operation {
  CsgOp op = CsgOp::unite;
  std::uint32_t children = 0;
  bool operator==(const Operation&) const = default;
};

/// A shell of light around a place: a sphere, or a tube without ends. A ray that comes in through it goes on
/// unchanged and gains color * (1 - s)^exponent, where s is the sine of the angle between the ray and the normal, in
/// local space and for a tube across its axis: 0 in the middle of its outline, 1 at the rim. It has no inside (so it
/// stands only in unions), casts no shadow, and its far side does not glow.
struct Glow {
  std::variant<Sphere, Cylinder> shape;
  glm::dvec3 color{1.0};
  std::uint32_t exponent = 16;
  bool operator==(const Glow&) const = default;
};

using NodeContent = std::variant<Operation, Solid, Glow>;

struct Node {
  NodeContent content;
  Affine parent_from_node;
  std::optional<std::uint32_t> material;  // index into Scene::materials; inherited by what is below
  std::optional<glm::dvec3> color;  // stands above any material's colour, also above one set further down
  std::vector<Texture> textures;    // those of ancestors come first
  std::string name;
  bool no_shadow = false;  // light passes the surfaces of all that is below
  bool operator==(const Node&) const = default;
};

// Cameras and lights. All cameras have a place and look along `direction` (any length > 0) with `up` upwards.

struct PerspectiveCamera {
  glm::dvec3 from{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  double angle_deg = 50;  // horizontal, full, 0 < angle < 180
  bool operator==(const PerspectiveCamera&) const = default;
};

// The pictures of the next two are discs, as large as the film allows, in its middle; around them there is no ray and
// the film is black. Below, r is the distance from the film's middle.

/// The angle to `direction` grows evenly with r.
struct FisheyeCamera {
  glm::dvec3 from{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  double angle_deg = 180;  // across the disc, 0 < angle <= 360
  bool operator==(const FisheyeCamera&) const = default;
};
/// What a parabolic mirror shows that has its focus at `from`. At film point (u, v), r = |(u, v)| and `radius` at the
/// disc's edge, the ray starts on the mirror at from + size * (u, v, (1 - r^2) / 2) in direction
/// (2u, 2v, 1 - r^2) / (1 + r^2), in axes right, up, forward: 90 degrees from `direction` where r = 1.
struct ParabolicCamera {
  glm::dvec3 from{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  double radius = 1;  // > 0
  double size = 0;    // >= 0, a length
  bool operator==(const ParabolicCamera&) const = default;
};

/// Parallel rays; the film stands at `from`, `width` wide.
struct OrthographicCamera {
  glm::dvec3 from{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  double width = 2;  // > 0, a length
  bool operator==(const OrthographicCamera&) const = default;
};
using Camera = std::variant<PerspectiveCamera, FisheyeCamera, ParabolicCamera, OrthographicCamera>;

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
  bool shadows = true, reflections = true, refractions = true;  // what is false here nobody can switch on
  bool operator==(const ImageDefaults&) const = default;
};
struct Animation {
  double start = 0, stop = 0, fps = 25;  // seconds; frame N shows start + N / fps
  bool operator==(const Animation&) const = default;
};

struct Scene {
  std::vector<Node> nodes;  // the tree in preorder; nodes[0] is the root
  std::vector<Material> materials;
  std::vector<Asset> assets;  // no two alike
  Camera camera;
  glm::dvec3 background{0.0, 0.02, 0.03};
  std::vector<Light> lights;
  ImageDefaults image;
  std::optional<Animation> animation;
  /// A surface is wherever another material begins, also inside a solid: see render/nested_media.h. Without it
  /// only the outside of the union of all is a surface, and outside of a material the index is 1.
  bool nested_media = false;
  bool operator==(const Scene&) const = default;
};

/// A scene (or script) that cannot be used. The message names the place and the fix.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

constexpr std::size_t max_nodes = 8'000'000;
constexpr std::uint32_t max_tree_depth = 256;
constexpr std::size_t max_lights = 1024;
constexpr std::size_t max_glows = 1024;
constexpr std::size_t max_textures = 16;  // of one node
constexpr std::size_t max_assets = 10'000;

/// Throws SceneError unless the scene can be rendered: the tree closes, indices are in range, numbers are
/// finite and in range, every leaf's transform can be inverted, the camera looks somewhere, all assets are here and are
/// what their users need; sheets stand in unions only.
void check(const Scene& scene);

}  // namespace rayfarm
