// What scripts say, and the scene it makes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/math/affine.h"
#include "tests/master/script/script_support.h"

namespace rayfarm {
namespace {

TEST(Language, EachSolidIsMadeByItsName) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(scene_with("sphere{}").nodes[0].content, (NodeContent(Sphere{})));
  EXPECT_EQ(std::get<Solid>(scene_with("cube{}").nodes[0].content), Solid(Cube{}));
  EXPECT_EQ(std::get<Solid>(scene_with("plane{}").nodes[0].content), Solid(Plane{}));
  EXPECT_EQ(std::get<Solid>(scene_with("cylinder{}").nodes[0].content), Solid(Cylinder{-inf, inf}));
  EXPECT_EQ(std::get<Solid>(scene_with("cylinder{ -1, 2 }").nodes[0].content), Solid(Cylinder{-1, 2}));
  EXPECT_EQ(std::get<Solid>(scene_with("cylinder{ zmax = 2 }").nodes[0].content), Solid(Cylinder{-inf, 2}));
  EXPECT_EQ(std::get<Solid>(scene_with("cylinder{ 0, math.huge }").nodes[0].content),
            Solid(Cylinder{0, inf}));
  EXPECT_EQ(std::get<Solid>(scene_with("cone{}").nodes[0].content), Solid(Cone{0, 1}));
  EXPECT_EQ(std::get<Solid>(scene_with("cone{ zmin = -1 }").nodes[0].content), Solid(Cone{-1, 1}));
  EXPECT_EQ(std::get<Solid>(scene_with("torus{ 2, 0.5 }").nodes[0].content), Solid(Torus{2, 0.5}));
  EXPECT_EQ(std::get<Solid>(scene_with("torus{ r = 2, R = 3 }").nodes[0].content), Solid(Torus{3, 2}));
  EXPECT_EQ(std::get<Solid>(scene_with("rounded_cube{ 0.3 }").nodes[0].content), Solid(RoundedCube{0.3}));
}

TEST(Language, TheTreeIsWrittenInPreorder) {
  const Scene scene =
      scene_with("union{ difference{ cube{}, sphere{} }, xor{ torus{} }, intersection{ plane{} } }");
  ASSERT_EQ(scene.nodes.size(), 8u);
  EXPECT_EQ(std::get<Operation>(scene.nodes[0].content), (Operation{CsgOp::unite, 3}));
  EXPECT_EQ(std::get<Operation>(scene.nodes[1].content), (Operation{CsgOp::subtract, 2}));
  EXPECT_EQ(std::get<Solid>(scene.nodes[2].content), Solid(Cube{}));
  EXPECT_EQ(std::get<Operation>(scene.nodes[4].content), (Operation{CsgOp::exclusive_or, 1}));
  EXPECT_EQ(std::get<Operation>(scene.nodes[6].content), (Operation{CsgOp::intersect, 1}));
}

TEST(Language, TransformsApplyInTheOrderInWhichTheyAreWritten) {
  const auto transform = [](const std::string& calls) {
    return scene_with("sphere{}" + calls).nodes[0].parent_from_node;
  };
  EXPECT_EQ(transform(":scale(2):translate(1, 0, 0)"), translation({1, 0, 0}) * scaling({2, 2, 2}));
  EXPECT_EQ(transform(":translate({1, 2, 3}):scale(1, 2, 3)"), scaling({1, 2, 3}) * translation({1, 2, 3}));
  EXPECT_EQ(transform(":rotate_x(30):rotate_y(40):rotate_z(50)"),
            rotation_deg(2, 50) * (rotation_deg(1, 40) * rotation_deg(0, 30)));
  EXPECT_EQ(transform(":rotate({0, 1, 1}, 20)"), rotation_deg(glm::dvec3(0, 1, 1), 20));
  EXPECT_EQ(transform(":rotate(0, 1, 1, 20)"), rotation_deg(glm::dvec3(0, 1, 1), 20));
  const Affine matrix = transform(":matrix{ {1, 2, 3, 10}, {0, 1, 4, 20}, {5, 6, 0, 30} }");
  EXPECT_EQ(point(matrix, {1, 1, 1}), glm::dvec3(16, 25, 41));
}

TEST(Language, NodesAreValues) {
  const Scene scene = scene_with("union{ a, b, a, b:color{0, 1, 0} }", R"(
    local a = sphere{}
    local b = a:translate(1, 0, 0):color{1, 0, 0}:name("b"))");
  Node ball;
  ball.content = Solid(Sphere{});
  EXPECT_EQ(scene.nodes[1], ball);
  EXPECT_EQ(scene.nodes[2].color, glm::dvec3(1, 0, 0));
  EXPECT_EQ(scene.nodes[2].name, "b");
  EXPECT_EQ(scene.nodes[3], ball);
  EXPECT_EQ(scene.nodes[4].color, glm::dvec3(0, 1, 0));
}

TEST(Language, ATableGivenToAnOperationMayChangeAfterwards) {
  EXPECT_EQ(
      scene_with("u", "local list = { sphere{}, cube{} } local u = union(list) list[1] = nil list[2] = nil")
          .nodes.size(),
      3u);
}

TEST(Language, ASecondAttributeReplacesTheFirst) {
  const Scene scene = scene_with(
      "sphere{}:color(0.5):color{1, 0, 0}:name('a'):name('b'):material(phong{}):material(phong{ index = 2 })"
      ":texture(checker{}):texture(checker{ 1, 2, {1, 0, 0} }, checker{ fu = 3, color = 0.25 })");
  EXPECT_EQ(scene.nodes[0].color, glm::dvec3(1, 0, 0));
  EXPECT_EQ(scene.nodes[0].name, "b");
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].index, 2);
  const std::vector<Texture> textures{Checker{1, 2, {1, 0, 0}}, Checker{3, 1, glm::dvec3(0.25)}};
  EXPECT_EQ(scene.nodes[0].textures, textures);
}

TEST(Language, AMaterialUsedTwiceIsOneInTheScene) {
  const Scene scene =
      scene_with("union{ cube{}:material(m), sphere{}:material(m), cube{}:material(phong{}) }",
                 "local m = phong{ specular = 0.5 }");
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.nodes[1].material, scene.nodes[2].material);
}

TEST(Language, ASceneHasAllThatItSays) {
  const Scene scene = run(R"(return scene{
      camera = perspective{ from = {1, 2, 3}, direction = {0, 0, -2}, up = {1, 0, 0}, angle = 33 },
      background = 0.5,
      lights = { ambient(0.5), ambient{0.1, 0.2, 0.3}, point{ at = {1, 2, 3}, intensity = {1, 2, 3} },
                 rectangle{ at = {1, 1, 1}, width = {1, 0, 0}, height = {0, 2, 0}, intensity = 3, dim = {1, 2, 3} } },
      root = sphere{}:material(phong{ color = {0.1, 0.2, 0.3}, ambient = 0.4, diffuse = 0.5, specular = 0.6, exponent = 7,
                                      transmission = 0.8, index = 1.9, schlick = 0 }),
      image = { width = 320, height = 200, spp = 9, reflections = false }, animation = { start = 0, stop = 20, fps = 25 } })")
                          .scene;
  EXPECT_EQ(scene.camera, Camera(PerspectiveCamera{{1, 2, 3}, {0, 0, -2}, {1, 0, 0}, 33}));
  EXPECT_EQ(scene.background, glm::dvec3(0.5));
  const std::vector<Light> lights{
      AmbientLight{glm::dvec3(0.5)}, AmbientLight{{0.1, 0.2, 0.3}}, PointLight{{1, 2, 3}, {1, 2, 3}},
      RectangleLight{{1, 1, 1}, {1, 0, 0}, {0, 2, 0}, glm::dvec3(3.0), {1, 2, 3}}};
  EXPECT_EQ(scene.lights, lights);
  EXPECT_EQ(scene.materials[0], (Material{{0.1, 0.2, 0.3}, 0.4, 0.5, 0.6, 7, 0.8, 1.9, 0}));
  EXPECT_EQ(scene.image, (ImageDefaults{320, 200, 9, true, false, true}));
  EXPECT_EQ(scene.animation, (Animation{0, 20, 25}));
}

TEST(Language, CamerasOfAllKinds) {
  const auto camera = [](const std::string& words) {
    return run("return scene{ root = sphere{}, camera = " + words + " }").scene.camera;
  };
  EXPECT_EQ(camera("fisheye{ from = {1, 2, 3}, direction = {1, 0, 0}, up = {0, 0, 1}, angle = 360 }"),
            Camera(FisheyeCamera{{1, 2, 3}, {1, 0, 0}, {0, 0, 1}, 360}));
  EXPECT_EQ(camera("parabolic{ from = {1, 2, 3}, radius = 2, size = 0.5 }"),
            Camera(ParabolicCamera{{1, 2, 3}, {0, 0, 1}, {0, 1, 0}, 2, 0.5}));
  EXPECT_EQ(camera("orthographic{ direction = {0, -1, 0}, up = {0, 0, 1}, width = 8 }"),
            Camera(OrthographicCamera{{0, 0, 0}, {0, -1, 0}, {0, 0, 1}, 8}));
  EXPECT_EQ(camera("fisheye{}"), Camera(FisheyeCamera{}));
  EXPECT_EQ(camera("parabolic{}"), Camera(ParabolicCamera{}));
  EXPECT_EQ(camera("orthographic{}"), Camera(OrthographicCamera{}));
}

TEST(Language, GlowShellsStripesAndPartsWithoutAShadow) {
  const Scene scene = scene_with(
      "union{ glow_cylinder{ -1, 2, color = {1, 1, 0}, exponent = 3 }, glow_sphere{}:scale(2), "
      "sphere{}:no_shadow():texture(stripes{ 2, 3, {0.7, 0, 0} }, stripes{}) }");
  EXPECT_EQ(scene.nodes[1].content, NodeContent(Glow{Cylinder{-1, 2}, {1, 1, 0}, 3}));
  EXPECT_EQ(scene.nodes[2].content, NodeContent(Glow{}));
  EXPECT_EQ(scene.nodes[2].parent_from_node, scaling(glm::dvec3(2)));
  EXPECT_TRUE(scene.nodes[3].no_shadow);
  EXPECT_FALSE(scene.nodes[0].no_shadow);
  EXPECT_EQ(scene.nodes[3].textures, (std::vector<Texture>{Stripes{2, 3, {0.7, 0, 0}}, Stripes{}}));
}

TEST(Language, WhatASceneDoesNotSayHasItsDefault) {
  Scene plain;
  plain.nodes = {Node{}};
  plain.nodes[0].content = Solid(Sphere{});
  EXPECT_EQ(scene_with("sphere{}"), plain);
  EXPECT_EQ(run("return scene{ root = sphere{}:material(phong{}) }").scene.materials[0], Material{});
}

TEST(Language, TimeIsThatOfTheFrame) {
  const auto x = [](std::uint32_t frame) {
    return run("return scene{ root = sphere{}:translate(time, 0, 0), animation = { start = 2, stop = 9, fps "
               "= 4 } }",
               {}, frame)
        .scene.nodes[0]
        .parent_from_node.offset.x;
  };
  EXPECT_EQ(x(0), 2);
  EXPECT_EQ(x(6), 3.5);
}

TEST(Language, ASceneWithoutAnimationHasFrame0Only) {
  const std::string still = "return scene{ root = sphere{}:translate(time, 0, 0) }";
  EXPECT_EQ(run(still, {}, 0).scene.nodes[0].parent_from_node.offset.x, 0);
  EXPECT_THROW(run(still, {}, 1), SceneError);
}

TEST(Language, AFrameAfterTheAnimationsLastOneIsRefused) {
  const auto frame = [](std::uint32_t number) {
    return run("return scene{ root = sphere{}, animation = { stop = 0.29, fps = 100 } }", {}, number);
  };
  EXPECT_NO_THROW(frame(29));
  try {
    frame(30);
    ADD_FAILURE() << "there is no frame 30";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("last frame is 29 (from 0 s to 0.29 s, 100 frames a second)"),
              std::string::npos)
        << error.what();
  }
}

TEST(Language, AFrameIsTheSameWhenTheAnimationIsKnownBefore) {
  const std::string script =
      "return scene{ root = sphere{}:translate(time, 0, 0), animation = { start = 1, stop = 9 } }";
  ScriptRequest request{"test.lua", script, {}, 50, {}};
  const Scene asked = std::get<ScriptResult>(run_script({request, {}, {}})).scene;
  request.animation = asked.animation;
  EXPECT_EQ(std::get<ScriptResult>(run_script({request, {}, {}})).scene, asked);
  request.frame = 201;
  EXPECT_THROW(run_script({request, {}, {}}), SceneError);
}

TEST(Language, AnAnimationThatChangesWithTimeIsRefused) {
  EXPECT_NE(complaint("return scene{ root = sphere{}, animation = { start = 1, stop = 9 + time } }")
                .find("change with time"),
            std::string::npos);
}

// Parameters. -----------------------------------------------------------------------------------------------

const char* const declaration = R"(
  local depth = param{ "depth", type = "int", default = 5, min = 1, max = 9, help = "recursion depth" }
  local size = param{ "size", type = "number", default = 1 }
  local mat = param{ "mat", choices = { "mirror", "glass" }, default = "glass" }
  local flat = param{ "flat", default = false }
  local word = param{ name = "word", default = "hello" }
  return scene{ root = sphere{}:scale(size):translate(depth, flat and 1 or 0, 0):name(mat .. " " .. word) })";

TEST(Parameters, AreListedWithTypeDefaultAndHelp) {
  const std::vector<ScriptParameter> wanted{{"depth", "int", "5", "recursion depth", {}, 1, 9},
                                            {"size", "number", "1", "", {}, {}, {}},
                                            {"mat", "choice", "glass", "", {"mirror", "glass"}, {}, {}},
                                            {"flat", "boolean", "false", "", {}, {}, {}},
                                            {"word", "string", "hello", "", {}, {}, {}}};
  EXPECT_EQ(run(declaration).parameters, wanted);
}

TEST(Parameters, HaveTheUsersValueOrTheDefault) {
  const Node given =
      run(declaration,
          {{"depth", "7"}, {"size", "0.5"}, {"mat", "mirror"}, {"flat", "true"}, {"word", "a=b c"}})
          .scene.nodes[0];
  EXPECT_EQ(given.parent_from_node, translation({7, 1, 0}) * scaling(glm::dvec3(0.5)));
  EXPECT_EQ(given.name, "mirror a=b c");
  EXPECT_EQ(run(declaration).scene.nodes[0].parent_from_node.offset, glm::dvec3(5, 0, 0));
}

TEST(Parameters, ThatDoNotFitAreRefused) {
  EXPECT_EQ(complaint(declaration, {{"depth", "10"}}),
            "test.lua:2: parameter depth must be at most 9, is 10");
  EXPECT_EQ(complaint(declaration, {{"depth", "0"}}), "test.lua:2: parameter depth must be at least 1, is 0");
  EXPECT_EQ(complaint(declaration, {{"depth", "2.5"}}),
            "test.lua:2: parameter depth must be a whole number, is '2.5'");
  EXPECT_EQ(complaint(declaration, {{"size", "nan"}}),
            "test.lua:3: parameter size must be a number, is 'nan'");
  EXPECT_EQ(complaint(declaration, {{"mat", "glas"}}),
            "test.lua:4: parameter mat must be one of mirror, glass, is 'glas', did you mean 'glass'?");
  EXPECT_EQ(complaint(declaration, {{"flat", "yes"}}),
            "test.lua:5: parameter flat must be true or false, is 'yes'");
  EXPECT_EQ(complaint(declaration, {{"deph", "1"}}),
            "test.lua: the script has no parameter 'deph', did you mean 'depth'?; it has: depth, size, mat, "
            "flat, word");
  EXPECT_EQ(complaint("return scene{ root = sphere{} }", {{"x", "1"}}),
            "test.lua: the script has no parameter 'x'; it has none");
}

TEST(Parameters, MustBeDeclaredSoundly) {
  const auto declared = [](const std::string& fields) { return complaint("param{ " + fields + " }"); };
  EXPECT_EQ(declared("default = 1"), "test.lua:1: param: name is missing");
  EXPECT_EQ(declared("'a'"), "test.lua:1: param: default is missing");
  EXPECT_EQ(declared("'a', type = 'integer', default = 1"),
            "test.lua:1: param: type must be one of int, number, string, boolean, choice, is 'integer'");
  EXPECT_EQ(declared("'a', type = 'int', default = 1.5"),
            "test.lua:1: param: the default of a must be of type int, is the number 1.5");
  EXPECT_EQ(declared("'a', default = 5, max = 3"), "test.lua:1: parameter a must be at most 3, is 5");
  EXPECT_EQ(declared("'a', type = 'choice', default = 'x'"),
            "test.lua:1: param: type choice and a list of choices go together");
  EXPECT_EQ(complaint("param{ 'a', default = 1 } param{ 'a', default = 1 }"),
            "test.lua:1: param: a is declared twice");
}

}  // namespace
}  // namespace rayfarm
