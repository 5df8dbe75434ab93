#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "common/scene/scene.h"

namespace rayfarm {
namespace {

[[noreturn]] void fail(const std::string& place, const std::string& what) {
  throw SceneError(place + ": " + what);
}

std::string text(double x) {
  std::string s = std::to_string(x);
  if (!std::isfinite(x) || s.find('.') == std::string::npos) return s;
  s.erase(s.find_last_not_of('0') + 1);
  if (s.back() == '.') s.pop_back();
  return s;
}

void check_finite(const glm::dvec3& v, const std::string& place, std::string_view what) {
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(v[i])) fail(place, std::string(what) + " must be finite numbers, has " + text(v[i]));
}

/// Colours, intensities and weights: finite and not negative.
void check_weight(double x, const std::string& place, std::string_view what) {
  if (!(std::isfinite(x) && x >= 0))
    fail(place, std::string(what) + " must be finite and not negative, is " + text(x));
}
void check_weight(const glm::dvec3& v, const std::string& place, std::string_view what) {
  for (int i = 0; i < 3; ++i) check_weight(v[i], place, what);
}
void check_positive(double x, const std::string& place, std::string_view what) {
  if (!(std::isfinite(x) && x > 0)) fail(place, std::string(what) + " must be positive, is " + text(x));
}

// The tree. -------------------------------------------------------------------------------------------------

std::string_view name_of(CsgOp op) {
  switch (op) {
    case CsgOp::unite:
      return "union";
    case CsgOp::intersect:
      return "intersection";
    case CsgOp::subtract:
      return "difference";
    case CsgOp::exclusive_or:
      return "xor";
  }
  return "unknown operation";
}

struct KindName {
  std::string_view operator()(const Operation& o) const { return name_of(o.op); }
  std::string_view operator()(const Solid& s) const { return kind_of(s); }
  std::string_view operator()(const Glow& g) const {
    return std::holds_alternative<Sphere>(g.shape) ? "glow sphere" : "glow cylinder";
  }
};

std::string place_of(const Scene& scene, std::size_t node) {
  const Node& n = scene.nodes[node];
  std::string place = "node " + std::to_string(node) + " (" + std::string(std::visit(KindName{}, n.content));
  if (!n.name.empty()) place += " \"" + n.name + "\"";
  return place + ")";
}

/// What is wrong with a solid's own numbers; empty when nothing is.
struct SolidFault {
  std::string operator()(const Cylinder& c) const { return fault_of_limits(c.z_min, c.z_max); }
  std::string operator()(const Cone& c) const { return fault_of_limits(c.z_min, c.z_max); }
  std::string operator()(const Torus& t) const {
    if (!(std::isfinite(t.R) && t.R > 0)) return "R must be positive, is " + text(t.R);
    if (!(std::isfinite(t.r) && t.r > 0)) return "r must be positive, is " + text(t.r);
    return {};
  }
  std::string operator()(const RoundedCube& c) const {
    if (c.r > 0 && c.r <= 0.5) return {};
    return "r must be above 0 and at most 0.5, is " + text(c.r);
  }
  template <class WithoutNumbers>
  std::string operator()(const WithoutNumbers&) const {
    return {};
  }

 private:
  static std::string fault_of_limits(double z_min, double z_max) {
    if (z_min < z_max) return {};
    return "z_min must be below z_max, but they are " + text(z_min) + " and " + text(z_max);
  }
};

std::string fault_of(const Glow& glow, const Node& node) {
  if (node.material || node.color || !node.textures.empty())
    return "a glow shell has no surface, so no material, color or texture; it has a color of its own";
  return std::visit(SolidFault{}, glow.shape);
}

// Assets. ---------------------------------------------------------------------------------------------------

/// What is wrong with the use of an asset as that kind of content; empty when nothing is.
template <class Content>
std::string fault_of_use(const Scene& scene, std::uint32_t asset, std::string_view kind) {
  if (asset >= scene.assets.size())
    return "asset " + std::to_string(asset) + " does not exist, the scene has " +
           std::to_string(scene.assets.size());
  if (std::holds_alternative<Content>(*scene.assets[asset].content())) return {};
  return "asset " + std::to_string(asset) + " is no " + std::string(kind);
}

std::string fault_of_asset(const Scene& scene, const Solid& solid) {
  if (const auto* mesh = std::get_if<Mesh>(&solid))
    return fault_of_use<TriangleMesh>(scene, mesh->asset, "mesh");
  if (const auto* bezier = std::get_if<Bezier>(&solid))
    return fault_of_use<BezierGrid>(scene, bezier->asset, "Bezier surface");
  return {};
}

/// Tells which assets are sheets: surfaces that do not enclose a volume. Looks at each once, and only when asked.
class Sheets {
 public:
  explicit Sheets(const Scene& scene) : scene_(scene) {}
  bool contain(std::uint32_t asset) {
    const auto [known, is_new] = known_.try_emplace(asset);
    if (is_new) known->second = std::visit(IsSheet{}, *scene_.assets[asset].content());
    return known->second;
  }

 private:
  struct IsSheet {
    bool operator()(const Image&) const { return false; }
    bool operator()(const TriangleMesh& mesh) const { return !is_closed(mesh); }
    bool operator()(const BezierGrid& grid) const { return !is_closed(grid); }
  };
  const Scene& scene_;
  std::map<std::uint32_t, bool> known_;
};

void check_assets(const Scene& scene) {
  if (scene.assets.size() > max_assets)
    throw SceneError("scene: " + std::to_string(scene.assets.size()) + " assets are too many, at most " +
                     std::to_string(max_assets) + " are allowed");
  for (std::size_t i = 0; i < scene.assets.size(); ++i)
    if (!scene.assets[i].content()) fail("asset " + std::to_string(i), "its content is not here");
}

/// What is wrong with a node, its place in the tree aside; empty when nothing is. The common case makes no
/// text.
std::string fault_of(const Scene& scene, const Node& node, const Affine& world_from_node) {
  if (const auto* operation = std::get_if<Operation>(&node.content)) {
    if (operation->op > CsgOp::exclusive_or)
      return "the operation must be union, intersection, difference or xor";
    if (operation->children == 0) return "an operation needs at least one child";
  } else {
    const auto* glow = std::get_if<Glow>(&node.content);
    const auto* solid = std::get_if<Solid>(&node.content);
    std::string fault = glow ? fault_of(*glow, node) : std::visit(SolidFault{}, *solid);
    if (fault.empty() && solid) fault = fault_of_asset(scene, *solid);
    if (!fault.empty()) return fault;
  }
  if (!is_invertible(node.parent_from_node))
    return "its transform cannot be inverted: no scale may be 0, no number infinite or out of proportion";
  if (!is_invertible(world_from_node))
    return "its transform, with those above it, cannot be inverted: the whole flattens it or leaves the "
           "range of numbers";
  if (node.material && *node.material >= scene.materials.size())
    return "material " + std::to_string(*node.material) + " does not exist, the scene has " +
           std::to_string(scene.materials.size());
  return {};
}

struct TextureCheck {
  const Scene& scene;
  const std::string& place;
  void operator()(const Checker& checker) const { check_squares(checker, "the checker's "); }
  void operator()(const Stripes& stripes) const { check_squares(stripes, "the stripes' "); }
  void operator()(const ImageTexture& image) const {
    if (!std::isfinite(image.fu) || !std::isfinite(image.fv))
      fail(place, "the image's frequencies must be finite");
    if (const std::string fault = fault_of_use<Image>(scene, image.asset, "image"); !fault.empty())
      fail(place, fault);
  }

 private:
  template <class Squares>
  void check_squares(const Squares& texture, const std::string& name) const {
    if (!std::isfinite(texture.fu) || !std::isfinite(texture.fv))
      fail(place, name + "frequencies must be finite");
    check_weight(texture.color, place, name + "color");
  }
};

void check_surface(const Scene& scene, std::size_t index) {
  const Node& node = scene.nodes[index];
  if (!node.color && node.textures.empty()) return;
  const std::string place = place_of(scene, index);
  if (node.color) check_weight(*node.color, place, "color");
  if (node.textures.size() > max_textures)
    fail(place, "at most " + std::to_string(max_textures) + " textures on a node, has " +
                    std::to_string(node.textures.size()));
  for (const Texture& texture : node.textures) std::visit(TextureCheck{scene, place}, texture);
}

void check_glow(const Glow& glow, const std::string& place, bool in_unions) {
  if (!in_unions)
    fail(place, "a glow shell has no inside that could be cut or cut away, put it in unions only");
  check_weight(glow.color, place, "color");
}

/// Walks the preorder with a stack of open operations, so that no depth can exhaust the program's own stack.
void check_tree(const Scene& scene) {
  if (scene.nodes.empty()) throw SceneError("scene: the tree is empty, give it at least one solid");
  if (scene.nodes.size() > max_nodes)
    throw SceneError("scene: " + std::to_string(scene.nodes.size()) + " nodes are too many, at most " +
                     std::to_string(max_nodes) + " are allowed");
  struct Open {
    std::uint32_t children_left;
    Affine world_from_node;
    bool in_unions = true;  // this and all above
  };
  std::vector<Open> open{{1, Affine{}}};
  std::size_t glows = 0;
  Sheets sheets(scene);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    while (!open.empty() && open.back().children_left == 0) open.pop_back();
    if (open.empty()) fail(place_of(scene, i), "does not belong to the tree, which is complete before it");
    --open.back().children_left;

    const Affine world_from_node = open.back().world_from_node * scene.nodes[i].parent_from_node;
    const std::string fault = fault_of(scene, scene.nodes[i], world_from_node);
    if (!fault.empty()) fail(place_of(scene, i), fault);
    check_surface(scene, i);
    if (const auto* glow = std::get_if<Glow>(&scene.nodes[i].content)) {
      check_glow(*glow, place_of(scene, i), open.back().in_unions);
      if (++glows > max_glows)
        fail(place_of(scene, i), "at most " + std::to_string(max_glows) + " glow shells are allowed");
    }
    const auto* solid = std::get_if<Solid>(&scene.nodes[i].content);
    const std::uint32_t* asset = solid ? asset_of(*solid) : nullptr;
    if (asset && (scene.nested_media || !open.back().in_unions) && sheets.contain(*asset))
      fail(place_of(scene, i),
           "does not enclose a volume (it has open edges), so it cannot be part of an intersection, "
           "difference "
           "or xor, nor of a scene with nested media; close it, or put it in a union");

    if (const auto* operation = std::get_if<Operation>(&scene.nodes[i].content)) {
      if (open.size() >= max_tree_depth)
        fail(place_of(scene, i),
             "is nested too deep, at most " + std::to_string(max_tree_depth) + " levels are allowed");
      const bool in_unions = open.back().in_unions && operation->op == CsgOp::unite;
      open.push_back({operation->children, world_from_node, in_unions});
    }
  }
  for (const Open& o : open)
    if (o.children_left != 0)
      throw SceneError("scene: the tree does not close, the last operation lacks children");
}

// Materials, camera, lights. --------------------------------------------------------------------------------

void check_material(const Material& m, const std::string& place) {
  check_weight(m.color, place, "color");
  check_weight(m.ambient, place, "ambient");
  check_weight(m.diffuse, place, "diffuse");
  check_weight(m.specular, place, "specular");
  check_weight(m.transmission, place, "transmission");
  check_weight(m.schlick, place, "schlick");
  check_positive(m.index, place, "index");
}

/// Scaled to largest component 1, so that no length over- or underflows; zero stays zero.
glm::dvec3 scaled(const glm::dvec3& v) {
  const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  return largest == 0 ? v : v / largest;
}

struct LensCheck {
  void operator()(const PerspectiveCamera& c) const {
    if (!(c.angle_deg > 0 && c.angle_deg < 180))
      fail("camera", "angle must be above 0 and below 180 degrees, is " + text(c.angle_deg));
  }
  void operator()(const FisheyeCamera& c) const {
    if (!(c.angle_deg > 0 && c.angle_deg <= 360))
      fail("camera", "angle must be above 0 and at most 360 degrees, is " + text(c.angle_deg));
  }
  void operator()(const ParabolicCamera& c) const {
    check_positive(c.radius, "camera", "radius");
    check_weight(c.size, "camera", "size");
  }
  void operator()(const OrthographicCamera& c) const { check_positive(c.width, "camera", "width"); }
};

void check_axes(const glm::dvec3& direction, const glm::dvec3& upwards) {
  const std::string place = "camera";
  check_finite(direction, place, "direction");
  check_finite(upwards, place, "up");
  const glm::dvec3 d = scaled(direction), up = scaled(upwards), side = glm::cross(d, up);
  if (d == glm::dvec3(0.0)) fail(place, "direction must not be zero");
  if (up == glm::dvec3(0.0)) fail(place, "up must not be zero");
  constexpr double least_sine = 1e-10;  // below, rounding decides where up is
  if (glm::dot(side, side) <= least_sine * least_sine * glm::dot(d, d) * glm::dot(up, up))
    fail(place, "direction must not be parallel to up, give another up such as {0, 0, 1}");
}

void check_camera(const Camera& camera) {
  std::visit(
      [](const auto& c) {
        check_finite(c.from, "camera", "from");
        check_axes(c.direction, c.up);
      },
      camera);
  std::visit(LensCheck{}, camera);
}

struct LightCheck {
  const std::string& place;
  void operator()(const AmbientLight& l) const { check_weight(l.intensity, place, "intensity"); }
  void operator()(const PointLight& l) const {
    check_finite(l.at, place, "at");
    check_weight(l.intensity, place, "intensity");
  }
  void operator()(const RectangleLight& l) const {
    check_finite(l.at, place, "at");
    check_finite(l.width, place, "width");
    check_finite(l.height, place, "height");
    check_weight(l.intensity, place, "intensity");
    check_weight(l.dim, place, "dim");
    if (l.dim == glm::dvec3(0.0)) fail(place, "dim must not be all zeros, {1, 0, 0} means no dimming");
  }
};

void check_animation(const Animation& a) {
  const std::string place = "animation";
  if (!std::isfinite(a.start) || !std::isfinite(a.stop)) fail(place, "start and stop must be finite");
  if (a.stop < a.start)
    fail(place, "stop must not be before start, but they are " + text(a.stop) + " and " + text(a.start));
  check_positive(a.fps, place, "fps");
}

}  // namespace

void check(const Scene& scene) {
  check_assets(scene);
  check_tree(scene);
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    check_material(scene.materials[i], "material " + std::to_string(i));
  check_camera(scene.camera);
  check_weight(scene.background, "background", "color");

  if (scene.lights.size() > max_lights)
    throw SceneError("scene: " + std::to_string(scene.lights.size()) + " lights are too many, at most " +
                     std::to_string(max_lights) + " are allowed");
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::string place = "light " + std::to_string(i);
    std::visit(LightCheck{place}, scene.lights[i]);
  }
  for (const auto& [value, what] :
       {std::pair{scene.image.width, "width"}, {scene.image.height, "height"}, {scene.image.spp, "spp"}})
    if (value == 0u) fail("image", std::string(what) + " must be at least 1");
  if (scene.animation) check_animation(*scene.animation);
}

}  // namespace rayfarm
