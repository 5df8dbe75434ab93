#include "tests/support/random_scene.h"

#include <cmath>
#include <random>

#include "tests/support/solid_definitions.h"
#include "tests/support/surfaces.h"

namespace rayfarm {
namespace {

constexpr int max_levels = 5;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : bits_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * std::ldexp(double(bits_() >> 11), -53);
  }
  int one_of(int count) { return static_cast<int>(bits_() % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return between(0, 1) < probability; }
  double quarter(int low, int high) { return 0.25 * (low + one_of(high - low + 1)); }
  glm::dvec3 vec(double low, double high) {
    const double x = between(low, high), y = between(low, high), z = between(low, high);
    return {x, y, z};
  }

 private:
  std::mt19937_64 bits_;
};

// Where solids lie and how large they are: the two families differ in nothing else.
struct Placement {
  Affine (*leaf)(Dice&);
  Affine (*group)(Dice&);
  double (*length)(Dice&);  // 0.25 ... 1.5
};

Affine any_leaf(Dice& dice) {
  Affine m;
  do {
    for (int column = 0; column < 3; ++column) m.linear[column] = dice.vec(-1.2, 1.2);
  } while (std::abs(glm::determinant(m.linear)) < 0.15);
  m.offset = dice.vec(-1, 1);
  return m;
}

Affine any_group(Dice& dice) {
  Affine m;
  for (int column = 0; column < 3; ++column) m.linear[column] += dice.vec(-0.25, 0.25);
  m.offset = dice.vec(-0.5, 0.5);
  return m;
}

double any_length(Dice& dice) { return dice.between(0.25, 1.5); }

// Axes in any order and direction, lengths 1/2 ... 3/2, now and then sheared by a quarter.
Affine snapped_leaf(Dice& dice) {
  const int first = dice.one_of(3), turn = 1 + dice.one_of(2);
  Affine m{glm::dmat3(0.0), {dice.quarter(-4, 4), dice.quarter(-4, 4), dice.quarter(-4, 4)}};
  for (int column = 0; column < 3; ++column)
    m.linear[column][(first + column * turn) % 3] = (dice.chance(0.5) ? 1 : -1) * 0.5 * (1 + dice.one_of(3));
  if (dice.chance(0.2)) m.linear[dice.one_of(3)] += 0.25 * m.linear[dice.one_of(2)];
  return m;
}

Affine snapped_group(Dice& dice) {
  return {glm::dmat3(dice.chance(0.3) ? 0.5 : 1.0),
          {dice.quarter(-2, 2), dice.quarter(-2, 2), dice.quarter(-2, 2)}};
}

double snapped_length(Dice& dice) { return dice.quarter(1, 6); }

Solid random_solid(Dice& dice, const Placement& placement) {
  switch (dice.one_of(10)) {
    case 0:
    case 1:
    case 2:
      return Sphere{};
    case 3:
    case 4:
      return Cube{};
    case 5:
      return Plane{};
    case 6:
      return Cylinder{};
    case 7:
      return Cylinder{-placement.length(dice), placement.length(dice)};
    case 8:
      return Torus{placement.length(dice), placement.length(dice)};
    default:
      return Cone{-placement.length(dice), placement.length(dice)};
  }
}

Material random_material(Dice& dice) {
  Material m;
  m.color = dice.vec(0, 1);
  m.ambient = dice.between(0, 0.3), m.diffuse = dice.between(0.1, 0.7), m.specular = dice.between(0, 0.5);
  m.exponent = 1 + dice.one_of(100);
  m.transmission = dice.chance(0.3) ? dice.between(0.2, 0.9) : 0;
  m.index = dice.between(0.8, 2);
  m.schlick = dice.chance(0.2) ? 0 : 1;
  return m;
}

void dress(Dice& dice, Scene& scene, Node& node) {
  if (dice.chance(0.4)) node.material = dice.one_of(static_cast<int>(scene.materials.size()));
  if (dice.chance(0.2)) node.color = dice.vec(0, 1);
  if (dice.chance(0.2))
    node.textures.push_back(Checker{dice.between(1, 8), dice.between(1, 8), dice.vec(0, 1)});
}

void grow(Dice& dice, const Placement& placement, int level, Scene& scene) {
  const bool is_leaf = level > 0 && (level == max_levels || dice.chance(0.45));
  Node node;
  dress(dice, scene, node);
  if (is_leaf) {
    node.content = random_solid(dice, placement);
    node.parent_from_node = placement.leaf(dice);
    scene.nodes.push_back(node);
    return;
  }
  const Operation operation{static_cast<CsgOp>(dice.one_of(4)),
                            static_cast<std::uint32_t>(2 + dice.one_of(2))};
  node.content = operation;
  if (level > 0) node.parent_from_node = placement.group(dice);
  scene.nodes.push_back(node);
  for (std::uint32_t child = 0; child < operation.children; ++child) grow(dice, placement, level + 1, scene);
}

void light_up(Dice& dice, Scene& scene) {
  PerspectiveCamera camera;
  camera.from = dice.vec(-1, 1) + glm::dvec3(0, 0.5, -7);
  camera.direction = dice.vec(-0.5, 0.5) - camera.from;
  scene.camera = camera;
  scene.background = dice.vec(0, 0.5);
  scene.lights.push_back(AmbientLight{dice.vec(0.3, 1)});
  scene.lights.push_back(PointLight{dice.vec(-6, 6), dice.vec(0.3, 1)});
  if (dice.chance(0.5))
    scene.lights.push_back(RectangleLight{dice.vec(-6, 6), dice.vec(-1, 1), dice.vec(-1, 1), dice.vec(0.5, 2),
                                          dice.vec(0.1, 1)});
}

Camera another_camera(Dice& dice, const PerspectiveCamera& c) {
  switch (dice.one_of(4)) {
    case 0:
      return FisheyeCamera{c.from, c.direction, c.up, dice.between(20, 360)};
    case 1:
      return ParabolicCamera{c.from, c.direction, c.up, dice.between(0.1, 2), dice.between(0, 1)};
    case 2:
      return OrthographicCamera{c.from, c.direction, c.up, dice.between(2, 6)};
    default:
      return c;
  }
}

Node random_glow(Dice& dice) {
  Node node;
  Glow glow;
  glow.color = dice.vec(0, 1), glow.exponent = 1 + dice.one_of(20);
  if (dice.chance(0.5)) glow.shape = Cylinder{-dice.between(0, 2), dice.between(0, 2)};
  node.content = glow;
  node.parent_from_node = any_leaf(dice);
  return node;
}

Scene scene_of(std::uint64_t seed, const Placement& placement) {
  Dice dice(seed);
  Scene scene;
  for (int i = 0; i < 4; ++i) scene.materials.push_back(random_material(dice));
  grow(dice, placement, 0, scene);
  light_up(dice, scene);
  return scene;
}

}  // namespace

Scene random_special_scene(std::uint64_t seed) {
  Scene scene = random_scene(seed);
  Dice dice(~seed);
  scene.camera = another_camera(dice, std::get<PerspectiveCamera>(scene.camera));
  const std::vector<Solid> solids = all_solids();
  for (Node& node : scene.nodes) {
    if (std::holds_alternative<Solid>(node.content) && dice.chance(0.3))
      node.content = solids[static_cast<std::size_t>(dice.one_of(static_cast<int>(solids.size())))];
    node.no_shadow = dice.chance(0.2);
    for (Texture& texture : node.textures)
      if (dice.chance(0.5)) texture = Stripes{dice.between(-8, 8), dice.between(-8, 8), dice.vec(0, 1)};
  }
  std::vector<Node> parts(1);
  for (int i = 0; i < 4; ++i) parts.push_back(random_glow(dice));
  parts[0].content = Operation{CsgOp::unite, static_cast<std::uint32_t>(parts.size())};
  scene.nodes.insert(scene.nodes.begin(), parts.begin(), parts.end());
  return scene;
}

Scene random_faceted_scene(std::uint64_t seed) {
  Scene scene = seed % 2 == 0 ? random_scene(seed) : random_snapped_scene(seed);
  Dice dice(~seed);
  scene.assets = {Asset("cube", cube_mesh()), Asset("ball", ball_mesh(4, 6)),
                  Asset("round ball", ball_grid()), Asset("hill", hill_grid())};
  for (Node& node : scene.nodes) {
    auto* solid = std::get_if<Solid>(&node.content);
    if (!solid || dice.chance(0.3)) continue;
    if (std::holds_alternative<Cube>(*solid)) *solid = Mesh{0, false};
    if (std::holds_alternative<Sphere>(*solid))
      *solid = dice.chance(0.5) ? Solid{Mesh{1, false}} : Solid{Bezier{2}};
  }
  Node sheet, both;
  sheet.content = Solid{Bezier{3}}, sheet.parent_from_node = any_leaf(dice);
  both.content = Operation{CsgOp::unite, 2};
  dress(dice, scene, sheet);
  scene.nodes.insert(scene.nodes.begin(), {both, sheet});
  return scene;
}

Scene random_scene(std::uint64_t seed) { return scene_of(seed, {any_leaf, any_group, any_length}); }

Scene random_snapped_scene(std::uint64_t seed) {
  return scene_of(seed, {snapped_leaf, snapped_group, snapped_length});
}

}  // namespace rayfarm
