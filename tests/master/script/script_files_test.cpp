// Files that scripts name: read from their folder and below, decoded in the limited child.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/render/world_parts.h"
#include "master/files/image_file.h"
#include "master/script/script.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

namespace fs = std::filesystem;

constexpr const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class ScriptFiles : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  ScriptResult evaluated(const std::string& script) const {
    write("scene.lua", script);
    return evaluate_file(folder / "scene.lua", {}, 0);
  }
  std::string complaint(const std::string& script) const {
    try {
      evaluated(script);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  }
  ScratchFolder folder;
};

TEST_F(ScriptFiles, AMeshAndAnImageBecomeAssetsEachOnce) {
  write("parts/t.obj", triangle);
  Picture picture{{2, 1}, {0, 0, 0, 1, 1, 1}, {}};
  write_picture(folder / "two.png", picture, PngCurve::srgb);
  const ScriptResult result = evaluated(R"(
    local t = mesh{ file = "parts/t.obj" }:texture(picture{ file = "two.png", fu = 2 })
    return scene{ root = union{ t, t:translate(1, 0, 0), mesh{ file = "parts/t.obj", smooth = false } } })");
  ASSERT_EQ(result.scene.assets.size(), 2u);
  EXPECT_EQ(std::get<TriangleMesh>(*result.scene.assets[0].content()).triangles.size(), 1u);
  const auto& image = std::get<Image>(*result.scene.assets[1].content());
  EXPECT_EQ(image.width, 2u);
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(image.values),
            (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255}));
  ASSERT_EQ(result.assets.size(), 2u);
  EXPECT_EQ(result.assets[0].hash, result.scene.assets[0].digest());
  World world(result.scene);
  EXPECT_EQ(world.parts().leaves.size(), 3u);
}

TEST_F(ScriptFiles, FloatImagesStayLinear) {
  Picture picture{{1, 1}, {0.25f, 2, 0}, {}};
  write_picture(folder / "one.exr", picture, PngCurve::srgb);
  const ScriptResult result =
      evaluated("return scene{ root = plane{}:texture(picture{ file = 'one.exr' }) }");
  EXPECT_EQ(std::get<std::vector<float>>(std::get<Image>(*result.scene.assets[0].content()).values),
            (std::vector<float>{0.25f, 2, 0}));
}

TEST_F(ScriptFiles, OnlyThoseOfTheFolderAreRead) {
  write("t.obj", triangle);
  fs::create_directories(folder / "below");
  std::ofstream(folder / "below" / "scene.lua") << "return scene{ root = mesh{ file = '../t.obj' } }";
  EXPECT_THROW(evaluate_file(folder / "below" / "scene.lua", {}, 0), SceneError);
  fs::create_symlink(folder / "t.obj", folder / "below" / "link.obj");
  std::ofstream(folder / "below" / "scene.lua") << "return scene{ root = mesh{ file = 'link.obj' } }";
  EXPECT_THROW(evaluate_file(folder / "below" / "scene.lua", {}, 0), SceneError);
  EXPECT_EQ(complaint("return scene{ root = mesh{ file = '/etc/passwd' } }"),
            "scene.lua: cannot read \"/etc/passwd\": a script may only name files of its own folder and "
            "those below");
  EXPECT_EQ(complaint("return scene{ root = mesh{ file = 'none.obj' } }"),
            "scene.lua: cannot read \"none.obj\": there is no such file in the script's folder");
  EXPECT_THROW(evaluate({"scene.lua", "return scene{ root = mesh{ file = 't.obj' } }", {}, 0}), SceneError);
}

TEST_F(ScriptFiles, ABrokenFileIsNamedWithTheLineThatAskedForIt) {
  write("t.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n");
  EXPECT_EQ(complaint("\nreturn scene{ root = mesh{ file = 't.obj' } }"),
            "scene.lua:2: t.obj:3: names point 3, but the file has 2");
  write("t.png", "this is no picture");
  EXPECT_TRUE(complaint("return scene{ root = plane{}:texture(picture{ file = 't.png' }) }")
                  .starts_with("scene.lua:1: t.png is no image that can be read"));
}

TEST_F(ScriptFiles, AnOpenMeshIsNoOperandOfADifference) {
  write("t.obj", triangle);
  EXPECT_EQ(complaint("return scene{ root = union{ mesh{ file = 't.obj' }, sphere{} } }"), "");
  EXPECT_NE(complaint("return scene{ root = difference{ sphere{}, mesh{ file = 't.obj' } } }")
                .find("does not enclose a volume"),
            std::string::npos);
}

}  // namespace
}  // namespace rayfarm
