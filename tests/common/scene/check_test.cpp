#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "common/scene/scene.h"

namespace rayfarm {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

Node solid(Solid s) {
  Node node;
  node.content = s;
  return node;
}
Node operation(CsgOp op, std::uint32_t children) {
  Node node;
  node.content = Operation{op, children};
  return node;
}
/// union{ sphere "ball", torus } with a light of each kind.
Scene good_scene() {
  Scene scene;
  scene.nodes = {operation(CsgOp::unite, 2), solid(Sphere{}), solid(Torus{2, 0.5})};
  scene.nodes[0].material = 0;
  scene.nodes[1].name = "ball";
  scene.nodes[1].textures = {Checker{}};
  scene.nodes[1].color = glm::dvec3(1, 0, 0);
  scene.materials = {Material{}};
  scene.lights = {AmbientLight{}, PointLight{}, RectangleLight{}};
  scene.animation = Animation{0, 10, 25};
  return scene;
}
std::string complaint(const std::function<void(Scene&)>& spoil) {
  Scene scene = good_scene();
  spoil(scene);
  try {
    check(scene);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no complaint";
}
template <class T>
T& light(Scene& scene, std::size_t i) {
  return std::get<T>(scene.lights[i]);
}

TEST(Check, AGoodScenePasses) {
  EXPECT_NO_THROW(check(good_scene()));
  Scene infinite;
  infinite.nodes = {solid(Cylinder{})};  // without caps
  EXPECT_NO_THROW(check(infinite));
}

TEST(Check, AFaultyNodeIsNamedByNumberKindAndName) {
  EXPECT_EQ(complaint([](Scene& s) {
              s.nodes[1].parent_from_node = scaling({1, 0, 1});
            }),
            "node 1 (sphere \"ball\"): its transform cannot be inverted: no scale may be 0, no number "
            "infinite or out of proportion");
  EXPECT_EQ(complaint([](Scene& s) {
              s.nodes[2].content = Torus{2, -1};
            }),
            "node 2 (torus): r must be positive, is -1");
  EXPECT_EQ(complaint([](Scene& s) {
              s.nodes[2].content = Torus{nan, 1};
            }),
            "node 2 (torus): R must be positive, is nan");
  EXPECT_EQ(complaint([](Scene& s) {
              s.nodes[2].content = Cylinder{1, 1};
            }),
            "node 2 (cylinder): z_min must be below z_max, but they are 1 and 1");
  EXPECT_EQ(complaint([](Scene& s) {
              s.nodes[2].content = Cylinder{nan, 1};
            }),
            "node 2 (cylinder): z_min must be below z_max, but they are nan and 1");
  EXPECT_EQ(complaint([](Scene& s) { s.nodes[1].material = 1; }),
            "node 1 (sphere \"ball\"): material 1 does not exist, the scene has 1");
  EXPECT_EQ(complaint([](Scene& s) { s.nodes[1].color->y = -1; }),
            "node 1 (sphere \"ball\"): color must be finite and not negative, is -1");
  EXPECT_NE(complaint([](Scene& s) { std::get<Checker>(s.nodes[1].textures[0]).fu = inf; }).find("checker"),
            std::string::npos);
}

TEST(Check, AFlatteningWholeIsFoundThoughEachPartIsSound) {
  EXPECT_NE(complaint([](Scene& s) {
              s.nodes[0].parent_from_node = scaling(glm::dvec3(1e-80));
              s.nodes[1].parent_from_node = scaling(glm::dvec3(1e-80));
            }).find("with those above it"),
            std::string::npos);
}

TEST(Check, TheTreeMustCloseExactly) {
  EXPECT_NE(complaint([](Scene& s) { s.nodes.clear(); }).find("empty"), std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.nodes.pop_back(); }).find("does not close"), std::string::npos);
  EXPECT_NE(
      complaint([](Scene& s) { s.nodes.push_back(solid(Cube{})); }).find("node 3 (cube): does not belong"),
      std::string::npos);
  EXPECT_NE(
      complaint([](Scene& s) { s.nodes[0] = operation(CsgOp::unite, 0xffffffff); }).find("does not close"),
      std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.nodes[1] = operation(CsgOp::unite, 0); }).find("at least one child"),
            std::string::npos);
  EXPECT_NE(
      complaint([](Scene& s) { s.nodes[0] = operation(static_cast<CsgOp>(4), 2); }).find("must be union"),
      std::string::npos);
}

TEST(Check, DepthIsBoundedAndCannotHarm) {
  const auto nested = [](std::size_t operations) {
    Scene scene;
    scene.nodes.assign(operations, operation(CsgOp::unite, 1));
    scene.nodes.push_back(solid(Sphere{}));
    return scene;
  };
  EXPECT_NO_THROW(check(nested(max_tree_depth - 1)));
  EXPECT_THROW(check(nested(max_tree_depth)), SceneError);
  EXPECT_THROW(check(nested(1'000'000)), SceneError);
}

TEST(Check, WeightsAndColoursMustBeFiniteAndNotNegative) {
  for (const double bad : {-0.5, inf, nan}) {
    EXPECT_NE(complaint([&](Scene& s) {
                s.materials[0].diffuse = bad;
              }).find("material 0: diffuse must be finite and not negative"),
              std::string::npos);
    EXPECT_NE(complaint([&](Scene& s) { s.materials[0].color.z = bad; }).find("material 0: color"),
              std::string::npos);
    EXPECT_NE(
        complaint([&](Scene& s) { s.materials[0].index = bad; }).find("material 0: index must be positive"),
        std::string::npos);
    EXPECT_NE(complaint([&](Scene& s) { s.background.x = bad; }).find("background"), std::string::npos);
    EXPECT_NE(
        complaint([&](Scene& s) { light<AmbientLight>(s, 0).intensity.x = bad; }).find("light 0: intensity"),
        std::string::npos);
    EXPECT_NE(
        complaint([&](Scene& s) { light<PointLight>(s, 1).intensity.y = bad; }).find("light 1: intensity"),
        std::string::npos);
    EXPECT_NE(complaint([&](Scene& s) { light<RectangleLight>(s, 2).dim.y = bad; }).find("light 2: dim"),
              std::string::npos);
  }
  EXPECT_NE(complaint([](Scene& s) { s.materials[0].index = 0; }).find("index must be positive, is 0"),
            std::string::npos);
}

TEST(Check, LightsHavePlacesAndDimSomehow) {
  EXPECT_NE(complaint([](Scene& s) { light<PointLight>(s, 1).at.y = nan; }).find("light 1: at"),
            std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { light<RectangleLight>(s, 2).width.y = inf; }).find("light 2: width"),
            std::string::npos);
  EXPECT_NE(complaint([](Scene& s) {
              light<RectangleLight>(s, 2).dim = glm::dvec3(0.0);
            }).find("must not be all zeros"),
            std::string::npos);
  EXPECT_NE(complaint([](Scene& s) { s.lights.resize(max_lights + 1); }).find("too many"), std::string::npos);
}

TEST(Check, TheCameraLooksSomewhere) {
  const auto camera = [](auto spoil) {
    return complaint([&](Scene& s) { spoil(std::get<PerspectiveCamera>(s.camera)); });
  };
  EXPECT_EQ(camera([](PerspectiveCamera& c) { c.direction = glm::dvec3(0.0); }),
            "camera: direction must not be zero");
  EXPECT_EQ(camera([](PerspectiveCamera& c) { c.up = glm::dvec3(0.0); }), "camera: up must not be zero");
  EXPECT_NE(camera([](PerspectiveCamera& c) {
              c.direction = {0, -1e-30, 0};
            }).find("parallel to up"),
            std::string::npos);
  EXPECT_EQ(camera([](PerspectiveCamera& c) { c.direction *= 1e-300; }), "no complaint");
  EXPECT_NE(camera([](PerspectiveCamera& c) { c.from.x = inf; }).find("camera: from"), std::string::npos);
  for (const double bad : {0.0, 180.0, -10.0, nan})
    EXPECT_NE(camera([&](PerspectiveCamera& c) { c.angle_deg = bad; }).find("camera: angle must be above 0"),
              std::string::npos);
}

TEST(Check, EachKindOfCameraIsChecked) {
  const auto camera = [](const Camera& c) { return complaint([&](Scene& s) { s.camera = c; }); };
  for (const Camera& good : {Camera(FisheyeCamera{.angle_deg = 360}), Camera(ParabolicCamera{}),
                             Camera(OrthographicCamera{.width = 1e-30})})
    EXPECT_EQ(camera(good), "no complaint");
  EXPECT_EQ(camera(FisheyeCamera{.direction = {0, 2, 0}}).find("camera: direction must not be parallel"), 0u);
  EXPECT_EQ(camera(OrthographicCamera{.from = {0, nan, 0}}).find("camera: from"), 0u);
  for (const double bad : {0.0, -1.0, nan, inf}) {
    EXPECT_EQ(camera(FisheyeCamera{.angle_deg = bad}).find("camera: angle must be above 0 and at most 360"),
              0u);
    EXPECT_EQ(camera(ParabolicCamera{.radius = bad}).find("camera: radius must be positive"), 0u);
    EXPECT_EQ(camera(OrthographicCamera{.width = bad}).find("camera: width must be positive"), 0u);
  }
  EXPECT_EQ(camera(ParabolicCamera{.size = -1}), "camera: size must be finite and not negative, is -1");
}

TEST(Check, AGlowShellStandsInUnionsAndHasNoSurface) {
  const auto with_glow = [](const auto& spoil) {
    return complaint([&](Scene& s) {
      s.nodes[2] = Node{};
      s.nodes[2].content = Glow{};
      spoil(s);
    });
  };
  EXPECT_EQ(with_glow([](Scene&) {}), "no complaint");
  for (const CsgOp op : {CsgOp::intersect, CsgOp::subtract, CsgOp::exclusive_or})
    EXPECT_EQ(
        with_glow([&](Scene& s) {
          s.nodes[0].content = Operation{op, 2};
        }),
        "node 2 (glow sphere): a glow shell has no inside that could be cut or cut away, put it in unions "
        "only");
  EXPECT_EQ(with_glow([&](Scene& s) {
              s.nodes[0].content = Operation{CsgOp::subtract, 2};  // of a ball that is cut by a union
              s.nodes.insert(s.nodes.begin() + 2, operation(CsgOp::unite, 1));
            }).find("node 3 (glow sphere): a glow shell has no inside"),
            0u);
  EXPECT_EQ(with_glow([](Scene& s) {
              s.nodes[2].color = glm::dvec3(1);
            }).find("node 2 (glow sphere): a glow shell has no surface"),
            0u);
  EXPECT_EQ(with_glow([](Scene& s) {
              s.nodes[2].content = Glow{Cylinder{1, 0}};
            }).find("node 2 (glow cylinder): z_min must be below z_max"),
            0u);
  EXPECT_EQ(with_glow([](Scene& s) {
              s.nodes[2].content = Glow{Sphere{}, {0, -1, 0}};
            }),
            "node 2 (glow sphere): color must be finite and not negative, is -1");
  EXPECT_NE(with_glow([](Scene& s) {
              s.nodes[0].content = Operation{CsgOp::unite, 2 + max_glows};
              s.nodes.insert(s.nodes.end(), max_glows, s.nodes[2]);
            }).find("at most 1024 glow shells"),
            std::string::npos);
}

TEST(Check, ImageAndAnimationAreSane) {
  EXPECT_EQ(complaint([](Scene& s) { s.image.height = 0; }), "image: height must be at least 1");
  EXPECT_EQ(complaint([](Scene& s) { s.animation->fps = 0; }), "animation: fps must be positive, is 0");
  EXPECT_EQ(complaint([](Scene& s) { s.animation->stop = -1; }),
            "animation: stop must not be before start, but they are -1 and 0");
}

}  // namespace
}  // namespace rayfarm
