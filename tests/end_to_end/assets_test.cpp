// A scene with meshes, a Bezier surface and a picture: whoever renders it, it has the same bytes, and what is broken
// is told at the door.
#include <fstream>

#include "master/files/image_file.h"
#include "tests/end_to_end/farm_programs.h"

namespace rayfarm {
namespace {

class AssetPrograms : public FarmPrograms {
 protected:
  AssetPrograms() {
    write("tent.obj",
          "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1.5 0\nvt 0 0\nvt 1 0\nvt 0.5 1\n"
          "f 1/1 2/2 3/3\nf 1/1 3/2 4/3\nf 2/1 1/2 5/3\nf 3/1 2/2 5/3\nf 4/1 3/2 5/3\nf 1/1 4/2 5/3\n");
    write_picture(folder / "four.png", Picture{{2, 2}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0}, {}},
                  PngCurve::srgb);
    write("scene.lua", R"(
local image = picture{ file = "four.png", fu = 2, fv = 2 }
local tent = mesh{ file = "tent.obj", smooth = false }
local glass = phong{ color = {0.1, 0.2, 0.2}, transmission = 0.8, diffuse = 0.1 }
local sail = bezier{ {
  { {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0} }, { {0, 1, 0}, {1, 1, 1}, {2, 1, 1}, {3, 1, 0} },
  { {0, 2, 0}, {1, 2, 1}, {2, 2, 1}, {3, 2, 0} }, { {0, 3, 0}, {1, 3, 0}, {2, 3, 0}, {3, 3, 0} } } }
return scene{
  camera = perspective{ from = {0.2, 1.5, -6}, direction = {0, -0.2, 1}, angle = 50 },
  lights = { ambient(0.4), point{ at = {-4, 6, -5} } },
  root = union{
    difference{ tent, sphere{}:scale(0.5):translate(0, 0.5, -0.7) }:texture(image),
    tent:material(glass):translate(1.6, 0, -1),
    sail:scale(0.7):translate(-3, 0, 1):texture(image),
    plane{}:rotate_x(-90):color(0.5),
  },
})");
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  Words picture() const { return {(folder / "scene.lua").string(), "--size", "150x110", "--spp", "2"}; }
};

TEST_F(AssetPrograms, AFarmsPictureHasTheSameBytesAsALocalOne) {
  const std::string expected = rendered_here(picture());
  start_master({"--threads", "1"});
  for (const char* name : {"pc1", "pc2"}) start_worker(name);
  wait_for_workers(3);
  EXPECT_TRUE(rendered_by_farm(picture()) == expected);
  EXPECT_TRUE(rendered_by_farm(picture()) == expected) << "a second time, with assets that are known";
}

TEST_F(AssetPrograms, EveryCommandTakesSuchAScene) {
  const Words scene = picture();
  EXPECT_EQ(rayfarm(Words{"map", "depth"} + scene + Words{"-o", (folder / "m.png").string()}).exit_code, 0);
  EXPECT_EQ(rayfarm(Words{"cloud"} + scene + Words{"-o", (folder / "c.ply").string()}).exit_code, 0);
  EXPECT_EQ(rayfarm(Words{"trace"} + scene + Words{"--pixel", "70,60"}).exit_code, 0);
  const ProgramResult stats = rayfarm(Words{"stats"} + scene);
  EXPECT_EQ(stats.exit_code, 0);
}

struct BrokenFile {
  std::string name, content, place;  // where, and what is wrong
};

std::vector<BrokenFile> broken_files() {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto ply = [](const std::string& format, const std::string& faces) {
    return "ply\nformat " + format + " 1.0\nelement vertex 3\nproperty float x\nproperty float y\n" +
           "property float z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n";
  };
  const std::string text = ply("ascii", "1"), binary = ply("binary_little_endian", "1");
  return {{"a.obj", points + "v 0 nan 0\nf 1 2 3\n", "a.obj:4: \"nan\" is no finite number"},
          {"a.obj", points + "f 1 2 9\n", "a.obj:4: names point 9, but the file has 3"},
          {"a.obj", points + "f 1 2", "a.obj:4: a face needs 3 corners, has 2"},
          {"a.obj", points, "a.obj has no triangles"},
          {"a.ply", text + "0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n", "a.ply:12: a vertex has a number that is not"},
          {"a.ply", text + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a.ply:13: a face names vertex 3"},
          {"a.ply", text + "0 0 0\n1 0 0\n0 1 0\n3 0", "the file ends too early"},
          {"a.ply", binary + std::string(36, '\0') + "\3" + std::string(6, '\0'), "the file ends too early"},
          {"a.ply", ply("binary_little_endian", "1000000000") + std::string(60, '\0'),
           "a.ply:10: the header announces 1000000000 of face"},
          {"a.ply", text + "0 0 0\n1 0 0\n", "a.ply:10: the header announces 3 of vertex"},
          {"a.ply", "", "a.ply"},
          {"a.png", "\x89PNG\r\n", "a.png"}};
}

TEST_F(AssetPrograms, ABrokenFileIsABadSceneThatNamesItsPlace) {
  start_master({"--threads", "0"});
  write("old.exr", "old");
  for (const auto& [name, content, place] : broken_files()) {
    write(name, content);
    const std::string use =
        name == "a.png" ? "sphere{}:texture(picture{ file = 'a.png' })" : "mesh{ file = '" + name + "' }";
    write("broken.lua", "return scene{\n  root = " + use + " }\n");
    for (const char* command : {"render", "submit"}) {
      const ProgramResult result =
          rayfarm({command, (folder / "broken.lua").string(), "-o", (folder / "old.exr").string()});
      EXPECT_EQ(result.exit_code, 2) << command << " " << place;
      EXPECT_NE(result.err.find("broken.lua:2"), std::string::npos) << result.err;
      EXPECT_NE(result.err.find(place), std::string::npos) << place << " in: " << result.err;
      EXPECT_LT(result.err.size(), 400u) << result.err;
      EXPECT_EQ(content_of(folder / "old.exr"), "old");
    }
  }
  EXPECT_TRUE(ask("/api/v1/jobs").at("jobs").empty());
}

}  // namespace
}  // namespace rayfarm
