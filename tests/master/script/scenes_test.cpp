// The bundled scenes against the facts of the original (tests/data/scenes): both are spread into their
// leaves, with all that is inherited, and compared leaf by leaf.
#include <gtest/gtest.h>

#include <cmath>
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
  std::vector<Checker> textures;
};

/// What is inherited on the way down.
struct Inherited {
  std::string path;
  Affine world_from_parent;
  Material material;
  std::optional<glm::dvec3> color;
  std::vector<Checker> textures;
};

Leaf leaf_of(const Inherited& above, std::string kind, std::vector<double> numbers) {
  return {std::move(kind),         above.path,     std::move(numbers),
          above.world_from_parent, above.material, above.color.value_or(above.material.color),
          above.textures};
}

// From our Scene. -------------------------------------------------------------------------------------------

const char* const operation_names[] = {"union", "intersection", "difference", "xor"};

std::size_t spread(const Scene& scene, std::size_t index, Inherited state, std::vector<Leaf>& leaves) {
  const Node& node = scene.nodes[index];
  state.world_from_parent = state.world_from_parent * node.parent_from_node;
  if (node.material) state.material = scene.materials[*node.material];
  if (node.color) state.color = node.color;
  for (const Texture& texture : node.textures) state.textures.push_back(std::get<Checker>(texture));

  if (const auto* solid = std::get_if<Solid>(&node.content)) {
    const char* const kinds[] = {"Sphere", "Cube", "Plane", "Cylinder", "Torus"};
    std::vector<double> numbers;
    if (const auto* c = std::get_if<Cylinder>(solid)) numbers = {c->z_min, c->z_max};
    leaves.push_back(leaf_of(state, kinds[solid->index()], numbers));
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

void spread(const json& node, Inherited state, std::vector<Leaf>& leaves) {
  if (node.contains("toParent"))
    state.world_from_parent = state.world_from_parent * affine_from(node.at("toParent"));
  const json attributes = node.value("attributes", json::object());
  if (attributes.contains("material")) state.material = material_from(attributes.at("material"));
  if (attributes.contains("color")) state.color = vector_from(attributes.at("color"));
  if (attributes.contains("texture")) {
    const json& t = attributes.at("texture");
    state.textures.push_back({t.at("fu"), t.at("fv"), vector_from(t.at("color2"))});
  }
  if (node.at("node") == "solid") {
    std::vector<double> numbers;
    if (node.at("type") == "Cylinder") numbers = {node.at("params").at("zMin"), node.at("params").at("zMax")};
    leaves.push_back(leaf_of(state, node.at("type"), numbers));
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
  EXPECT_EQ(ours.numbers, theirs.numbers) << what;
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

void expect_scene_is(const Scene& scene, const json& fact) {
  std::vector<Leaf> theirs;
  spread(fact.at("root"), {}, theirs);
  const std::vector<Leaf> ours = leaves_of(scene);
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i)
    expect_same(ours[i], theirs[i], "leaf " + std::to_string(i) + " " + theirs[i].path);

  const auto& camera = std::get<PerspectiveCamera>(scene.camera);
  expect_near(camera.from, vector_from(fact.at("camera").at("center")), "camera");
  expect_near(glm::normalize(camera.direction), vector_from(fact.at("camera").at("direction_normalized")),
              "direction");
  expect_near(camera.up, vector_from(fact.at("camera").at("up")), "up");
  EXPECT_EQ(camera.angle_deg, fact.at("camera").at("horizontalAngleDeg").get<double>());
  EXPECT_EQ(scene.background, vector_from(fact.at("background").at("color")));
  expect_same_lights(scene.lights, fact.at("lights"));
}

Scene scene_of(const std::string& name, std::map<std::string, std::string> params = {}) {
  return evaluate_file(std::string(RAYFARM_SOURCE_DIR) + "/scenes/" + name + ".lua", std::move(params), 0)
      .scene;
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

TEST(Scenes, SphereFlakeHasTheOriginalsDefaultsAndMaterials) {
  const json options = facts("SphereFlake").at("paramOptions");
  const auto flake_material = [](std::map<std::string, std::string> params) {
    params["depth"] = "1";
    return leaves_of(scene_of("sphere_flake", std::move(params))).front().material;
  };
  for (const auto& [name, values] : options.at("mat").at("values").items()) {
    Material m = flake_material({{"mat", name == "absent/other" ? "diffuse" : name}});
    const double index = name == "glass" ? 1.6 : values.at("n").get<double>();
    EXPECT_EQ(m, (Material{vector_from(values.at("color")), values.at("Ka"), values.at("Kd"), values.at("Ks"),
                           values.at("H"), values.at("Kt"), index, 1.0}));
  }
  EXPECT_EQ(flake_material({{"mat", "glass"}, {"n", "1.25"}}).index, 1.25);
  EXPECT_EQ(leaves_of(scene_of("sphere_flake")).size(), 2801u + 1);
  const std::vector<Leaf> small = leaves_of(scene_of("sphere_flake", {{"depth", "2"}, {"coef", "0.25"}}));
  EXPECT_EQ(small[1].world_from_leaf, translation({0, 1.25, 0}) * scaling({0.25, 0.25, 0.25}));
}

TEST(Scenes, AFlakeOf137257SpheresIsEvaluated) {
  EXPECT_EQ(leaves_of(scene_of("sphere_flake", {{"depth", "7"}})).size(), 137'257u + 1);
}

}  // namespace
}  // namespace rayfarm
