// The bundled scenes against the facts of the original (tests/data/scenes): both are spread into their
// leaves, with all that is inherited, and compared leaf by leaf.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "master/script/script.h"

namespace rayfarm {
namespace {

using nlohmann::json;

/// A leaf with what it inherits, and the operations above it: "union/difference/0.1" are the ways down.
struct Leaf {
  std::string kind, path;
  std::vector<double> numbers;  // of the solid
  Affine world_from_leaf;
  Material material;
  glm::dvec3 color{0.0};
  std::vector<Texture> textures;
  bool no_shadow = false;
};

/// What is inherited on the way down.
struct Inherited {
  std::string path;
  Affine world_from_parent;
  Material material;
  std::optional<glm::dvec3> color;
  std::vector<Texture> textures;
  bool no_shadow = false;
};

Leaf leaf_of(const Inherited& above, std::string kind, std::vector<double> numbers) {
  return {std::move(kind),         above.path,     std::move(numbers),
          above.world_from_parent, above.material, above.color.value_or(above.material.color),
          above.textures,          above.no_shadow};
}

// From our Scene. -------------------------------------------------------------------------------------------

const char* const operation_names[] = {"union", "intersection", "difference", "xor"};

/// The control points of each patch, row by row.
std::vector<double> numbers_of(const BezierGrid& grid) {
  std::vector<double> numbers;
  for (std::size_t patch = 0; patch < std::size_t{grid.rows} * grid.columns; ++patch)
    for (std::size_t i = 0; i < 16; ++i) {
      const Vec3d& p = grid.at(3 * (patch / grid.columns) + i / 4, 3 * (patch % grid.columns) + i % 4);
      numbers.insert(numbers.end(), {p.x, p.y, p.z});
    }
  return numbers;
}

struct KindAndNumbers {
  const Scene& scene;

  using Pair = std::pair<std::string, std::vector<double>>;
  Pair operator()(const Sphere&) const { return {"Sphere", {}}; }
  Pair operator()(const Cube&) const { return {"Cube", {}}; }
  Pair operator()(const Plane&) const { return {"Plane", {}}; }
  Pair operator()(const Cylinder& c) const { return {"Cylinder", {c.z_min, c.z_max}}; }
  Pair operator()(const Torus& t) const { return {"Torus", {t.R, t.r}}; }
  Pair operator()(const Bezier& b) const {
    return {"BezierSurface", numbers_of(std::get<BezierGrid>(*scene.assets[b.asset].content()))};
  }
  template <class Other>
  Pair operator()(const Other&) const {
    return {"not of the original's", {}};
  }
};

std::size_t spread(const Scene& scene, std::size_t index, Inherited state, std::vector<Leaf>& leaves) {
  const Node& node = scene.nodes[index];
  state.world_from_parent = state.world_from_parent * node.parent_from_node;
  if (node.material) state.material = scene.materials[*node.material];
  if (node.color) state.color = node.color;
  state.textures.insert(state.textures.end(), node.textures.begin(), node.textures.end());
  state.no_shadow = state.no_shadow || node.no_shadow;

  if (const auto* solid = std::get_if<Solid>(&node.content)) {
    const auto [kind, numbers] = std::visit(KindAndNumbers{scene}, *solid);
    leaves.push_back(leaf_of(state, kind, numbers));
    return index + 1;
  }
  if (const auto* glow = std::get_if<Glow>(&node.content)) {
    // As in the facts: a color that the callback gives, and no shadow.
    const auto [kind, numbers] = std::visit(KindAndNumbers{scene}, glow->shape);
    state.color = glow->color, state.no_shadow = true;
    EXPECT_EQ(glow->exponent, 16u);
    leaves.push_back(leaf_of(state, kind + "Front", numbers));
    return index + 1;
  }
  const Operation& operation = std::get<Operation>(node.content);
  const std::string path = state.path + "/" + operation_names[static_cast<int>(operation.op)] + " ";
  std::size_t next = index + 1;
  for (std::uint32_t i = 0; i < operation.children; ++i) {
    state.path = path + std::to_string(i);
    next = spread(scene, next, state, leaves);
  }
  return next;
}

std::vector<Leaf> leaves_of(const Scene& scene) {
  std::vector<Leaf> leaves;
  EXPECT_EQ(spread(scene, 0, {}, leaves), scene.nodes.size());
  return leaves;
}

// From the facts. -------------------------------------------------------------------------------------------

glm::dvec3 vector_from(const json& v) {
  return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
}

Affine affine_from(const json& rows) {
  Affine m;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      (column < 3 ? m.linear[column] : m.offset)[row] = rows.at(row).at(column).get<double>();
  return m;
}

Material material_from(const json& m) {
  return {vector_from(m.at("color")),
          m.at("Ka"),
          m.at("Kd"),
          m.at("Ks"),
          m.at("H"),
          m.at("Kt"),
          m.at("n"),
          m.at("schlick")};
}

Texture texture_from(const json& t) {
  if (t.at("type") == "CheckerTexture") return Checker{t.at("fu"), t.at("fv"), vector_from(t.at("color2"))};
  EXPECT_EQ(t.at("type"), "ObStripesTexture");
  return Stripes{t.at("fu"), t.at("fv"), vector_from(t.at("color2"))};
}

double number_from(const json& number) {
  if (number.is_number()) return number.get<double>();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return number == "+inf" ? infinity : -infinity;
}

std::vector<double> numbers_from(const std::string& type, const json& params) {
  std::vector<std::string> keys;
  if (type.starts_with("Cylinder")) keys = {"zMin", "zMax"};
  if (type == "Torus") keys = {"R", "r"};
  std::vector<double> numbers;
  for (const std::string& key : keys) numbers.push_back(number_from(params.at(key)));
  if (type == "BezierSurface")
    for (const json& patch : params.at("patches"))
      for (const json& point : patch.at("points_P00_P01_P02_P03_P10_etc"))
        for (const json& coordinate : point) numbers.push_back(coordinate.get<double>());
  return numbers;
}

void spread(const json& node, Inherited state, std::vector<Leaf>& leaves) {
  if (node.contains("toParent"))
    state.world_from_parent = state.world_from_parent * affine_from(node.at("toParent"));
  const json attributes = node.value("attributes", json::object());
  if (attributes.contains("material")) state.material = material_from(attributes.at("material"));
  if (attributes.contains("color")) state.color = vector_from(attributes.at("color"));
  if (attributes.contains("texture")) state.textures.push_back(texture_from(attributes.at("texture")));
  state.no_shadow = attributes.value("noShadow", false);
  if (node.at("node") == "solid") {
    const std::string type = node.at("type");
    if (attributes.contains("recursion"))  // the notes of CylindersGlow say which colors
      state.color = type == "CylinderFront" ? glm::dvec3(1, 1, 0) : glm::dvec3(0, 1.2, 1.2);
    leaves.push_back(leaf_of(state, type, numbers_from(type, node.at("params"))));
    return;
  }
  const std::string path = state.path + "/" + node.at("op").get<std::string>() + " ";
  for (std::size_t i = 0; i < node.at("children").size(); ++i) {
    state.path = path + std::to_string(i);
    spread(node.at("children").at(i), state, leaves);
  }
}

json facts(const std::string& name) {
  std::ifstream in(std::string(RAYFARM_SOURCE_DIR) + "/tests/data/scenes/" + name + ".json");
  return json::parse(in);
}

// Comparison. -----------------------------------------------------------------------------------------------

constexpr double tolerance = 1e-6;  // the original's angles are single precision

void expect_near(const glm::dvec3& a, const glm::dvec3& b, const std::string& what) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << what << "[" << i << "]";
}

void expect_same(const Leaf& ours, const Leaf& theirs, const std::string& what) {
  EXPECT_EQ(ours.kind, theirs.kind) << what;
  EXPECT_EQ(ours.path, theirs.path) << what;
  ASSERT_EQ(ours.numbers.size(), theirs.numbers.size()) << what;
  for (std::size_t i = 0; i < ours.numbers.size(); ++i)
    EXPECT_DOUBLE_EQ(ours.numbers[i], theirs.numbers[i]) << what;
  EXPECT_EQ(ours.no_shadow, theirs.no_shadow) << what;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) {
      const double x = theirs.world_from_leaf.linear[column][row];
      EXPECT_NEAR(ours.world_from_leaf.linear[column][row], x, tolerance * std::max(1.0, std::fabs(x)))
          << what;
    }
  expect_near(ours.world_from_leaf.offset, theirs.world_from_leaf.offset, what + " offset");
  expect_near(ours.color, theirs.color, what + " color");
  Material material = ours.material;
  material.color = theirs.material.color;  // compared as the effective colour
  EXPECT_EQ(material, theirs.material) << what;
  EXPECT_EQ(ours.textures, theirs.textures) << what;
}

void expect_same_lights(const std::vector<Light>& ours, const json& theirs) {
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const json& light = theirs.at(i);
    const glm::dvec3 intensity = vector_from(light.at("intensity"));
    if (light.at("type") == "AmbientLightSource")
      EXPECT_EQ(ours[i], Light(AmbientLight{intensity}));
    else if (light.at("type") == "PointLightSource")
      EXPECT_EQ(ours[i], Light(PointLight{vector_from(light.at("position")), intensity}));
    else
      EXPECT_EQ(ours[i], Light(RectangleLight{vector_from(light.at("position")),
                                              vector_from(light.at("edgeU")), vector_from(light.at("edgeV")),
                                              intensity, vector_from(light.at("dim"))}));
  }
}

void expect_same_camera(const Camera& ours, const json& theirs) {
  std::visit(
      [&](const auto& camera) {
        expect_near(camera.from, vector_from(theirs.at("center")), "camera");
        expect_near(glm::normalize(camera.direction), vector_from(theirs.at("direction_normalized")),
                    "direction");
        expect_near(camera.up, vector_from(theirs.value("up", json::array({0, 1, 0}))), "up");
      },
      ours);
  const auto* fisheye = std::get_if<FisheyeCamera>(&ours);
  const double angle = fisheye ? fisheye->angle_deg : std::get<PerspectiveCamera>(ours).angle_deg;
  EXPECT_EQ(angle, theirs.at(fisheye ? "apertureDeg" : "horizontalAngleDeg").get<double>());
}

void expect_same_image(const Scene& ours, const json& script_sets) {
  const auto expect_if_set = [&](const char* key, const std::optional<std::uint32_t>& value) {
    if (script_sets.contains(key)) {
      EXPECT_EQ(value, script_sets.at(key).get<std::uint32_t>());
    }
  };
  expect_if_set("Width", ours.image.width);
  expect_if_set("Height", ours.image.height);
  expect_if_set("SuperSampling", ours.image.spp);
  ASSERT_EQ(ours.animation.has_value(), script_sets.contains("End"));
  if (!ours.animation) return;
  EXPECT_EQ(*ours.animation,
            (Animation{script_sets.at("Start"), script_sets.at("End"), script_sets.at("Fps")}));
}

void expect_scene_is(const Scene& scene, const json& fact) {
  std::vector<Leaf> theirs;
  spread(fact.at("root"), {}, theirs);
  const std::vector<Leaf> ours = leaves_of(scene);
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i)
    expect_same(ours[i], theirs[i], "leaf " + std::to_string(i) + " " + theirs[i].path);

  expect_same_camera(scene.camera, fact.at("camera"));
  expect_same_image(scene, fact.value("scriptSets", json::object()));
  EXPECT_EQ(scene.background, vector_from(fact.at("background").at("color")));
  expect_same_lights(scene.lights, fact.at("lights"));
}

Scene scene_of(const std::string& name, std::map<std::string, std::string> params = {},
               std::uint32_t frame = 0) {
  return evaluate_file(std::string(RAYFARM_SOURCE_DIR) + "/scenes/" + name + ".lua", std::move(params), frame)
      .scene;
}

/// The material of a scene's first leaf of that kind.
Material material_of(const Scene& scene, const std::string& kind) {
  const std::vector<Leaf> leaves = leaves_of(scene);
  return std::find_if(leaves.begin(), leaves.end(), [&](const Leaf& leaf) { return leaf.kind == kind; })
      ->material;
}

/// As the facts list a parameter's choices; what is a parameter there is given here.
Material listed_material(const json& listed, double index, double schlick) {
  return {vector_from(listed.at("color")),
          listed.at("Ka"),
          listed.at("Kd"),
          listed.at("Ks"),
          listed.at("H"),
          listed.at("Kt"),
          listed.at("n").is_number() ? listed.at("n").get<double>() : index,
          schlick};
}

TEST(Scenes, SpherePlaneIsTheOriginals) { expect_scene_is(scene_of("sphere_plane"), facts("SpherePlane")); }
TEST(Scenes, HedgehogInTheCageIsTheOriginals) {
  expect_scene_is(scene_of("hedgehog_in_the_cage"), facts("HedgehogInTheCage"));
}
TEST(Scenes, CircusIsTheOriginals) { expect_scene_is(scene_of("circus"), facts("Circus")); }
TEST(Scenes, TestSceneIsTheOriginals) { expect_scene_is(scene_of("test_scene"), facts("TestScene")); }
TEST(Scenes, TestSceneWithARectangleLightIsTheOriginals) {
  expect_scene_is(scene_of("test_scene", {{"light", "rectangle"}}), facts("TestSceneRectLight"));
}
TEST(Scenes, SphereFlakeOfDepthTwoIsTheOriginals) {
  expect_scene_is(scene_of("sphere_flake", {{"depth", "2"}}), facts("SphereFlake"));
}

TEST(Scenes, TwoSpheresIsTheOriginals) { expect_scene_is(scene_of("two_spheres"), facts("TwoSpheres")); }
TEST(Scenes, FiveBallsIsTheOriginals) { expect_scene_is(scene_of("five_balls"), facts("FiveBalls")); }
TEST(Scenes, CubesIsTheOriginals) { expect_scene_is(scene_of("cubes"), facts("Cubes")); }
TEST(Scenes, CylindersIsTheOriginals) { expect_scene_is(scene_of("cylinders"), facts("Cylinders")); }
TEST(Scenes, CylindersGlowIsTheOriginals) {
  expect_scene_is(scene_of("cylinders_glow"), facts("CylindersGlow"));
}
TEST(Scenes, ToroidsIsTheOriginals) { expect_scene_is(scene_of("toroids"), facts("Toroids")); }
TEST(Scenes, ToroidsOrienteeringIsTheOriginals) {
  expect_scene_is(scene_of("toroids_orienteering"), facts("ToroidsOrienteering"));
}
TEST(Scenes, OpticsIsTheOriginals) { expect_scene_is(scene_of("optics"), facts("Optics")); }
TEST(Scenes, BezierIsTheOriginals) { expect_scene_is(scene_of("bezier"), facts("Bezier")); }
TEST(Scenes, GlasshengeIsTheOriginals) { expect_scene_is(scene_of("glasshenge"), facts("Glasshenge")); }
TEST(Scenes, FlagsIsTheOriginals) { expect_scene_is(scene_of("flags"), facts("Flags")); }
TEST(Scenes, AnimatedSceneIsTheOriginals) {
  expect_scene_is(scene_of("animated_scene"), facts("AnimatedScene"));
}

TEST(Scenes, MaterialsToChooseAreTheOriginals) {
  const auto expect_choices = [](const std::string& script, const std::string& fact, const std::string& kind,
                                 std::map<std::string, std::string> params) {
    const auto materials = facts(fact).at("paramOptions").at("mat").at("values");
    for (const auto& [name, values] : materials.items()) {
      params["mat"] = name == "absent/other" ? "diffuse" : name;
      EXPECT_EQ(material_of(scene_of(script, params), kind), listed_material(values, 1.6, 1))
          << script << name;
      params["n"] = "1.25";
      EXPECT_EQ(material_of(scene_of(script, params), kind), listed_material(values, 1.25, 1))
          << script << name;
      params.erase("n");
    }
  };
  expect_choices("sphere_flake", "SphereFlake", "Sphere", {{"depth", "1"}});
  expect_choices("cubes", "Cubes", "Cube", {});
  expect_choices("two_spheres", "TwoSpheres", "Sphere", {});
}

TEST(Scenes, SphereFlakeHasTheOriginalsDefaults) {
  EXPECT_EQ(leaves_of(scene_of("sphere_flake")).size(), 2801u + 1);
  const std::vector<Leaf> small = leaves_of(scene_of("sphere_flake", {{"depth", "2"}, {"coef", "0.25"}}));
  EXPECT_EQ(small[1].world_from_leaf, translation({0, 1.25, 0}) * scaling({0.25, 0.25, 0.25}));
}

TEST(Scenes, TwoSpheresTakesSchlicksFactorForBothMaterials) {
  for (const Leaf& leaf : leaves_of(scene_of("two_spheres", {{"schlick", "0.5"}})))
    EXPECT_EQ(leaf.material.schlick, 0.5);
}

TEST(Scenes, OpticsByRayCastingIsColored) {
  const Scene scene = scene_of("optics", {{"rc", "true"}, {"n", "1.5"}});
  const std::vector<Leaf> leaves = leaves_of(scene);
  const Material colored{{0.1, 0.3, 1}, 0.1, 0.8, 0.1, 32, 0.9, 1.5, 1};
  for (const std::size_t i : {0, 1, 3, 4}) EXPECT_EQ(leaves[i].material, colored);
  EXPECT_EQ(leaves[2].material, leaves[5].material) << "the ball behind is of what the root is";
  EXPECT_FALSE(scene.image.shadows || scene.image.reflections || scene.image.refractions);
  EXPECT_TRUE(scene_of("optics").image.refractions);
}

TEST(Scenes, AnimatedScenesCameraGoesAroundWhatItLooksAt) {
  const json camera = facts("AnimatedScene").at("camera");
  const glm::dvec3 look_at = vector_from(camera.at("lookAt"));
  const glm::dvec3 radial = vector_from(camera.at("centerAtStart")) - look_at;
  for (const std::uint32_t frame : {0u, 1u, 125u, 250u, 499u, 500u}) {
    const double angle = 2 * 3.14159265358979323846 * frame / 25 / 20;  // about y, by -angle
    const glm::dvec3 turned{std::cos(angle) * radial.x - std::sin(angle) * radial.z, radial.y,
                            std::sin(angle) * radial.x + std::cos(angle) * radial.z};
    const auto ours = std::get<PerspectiveCamera>(scene_of("animated_scene", {}, frame).camera);
    expect_near(ours.from, look_at + turned, "from");
    expect_near(glm::normalize(ours.direction), glm::normalize(-turned), "direction");
  }
  EXPECT_EQ(material_of(scene_of("animated_scene", {{"n", "1.25"}}), "Sphere").index, 1.25);
}

TEST(Scenes, EveryScriptSaysWhatItShows) {
  std::size_t scripts = 0;
  for (const auto& file : std::filesystem::directory_iterator(std::string(RAYFARM_SOURCE_DIR) + "/scenes")) {
    if (file.path().extension() != ".lua") continue;
    ++scripts;
    std::ifstream in(file.path());
    std::string first;
    std::getline(in, first);
    EXPECT_TRUE(first.starts_with("-- ")) << file.path();
    EXPECT_NO_THROW(evaluate_file(file.path(), {}, 0)) << file.path();
  }
  EXPECT_GE(scripts, 17u);
}

TEST(Scenes, AFlakeOf137257SpheresIsEvaluated) {
  EXPECT_EQ(leaves_of(scene_of("sphere_flake", {{"depth", "7"}})).size(), 137'257u + 1);
}

}  // namespace
}  // namespace rayfarm
