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

TEST_F(AssetPrograms, ABrokenFileIsABadScene) {
  write("tent.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
  const ProgramResult result =
      rayfarm(Words{"render"} + picture() + Words{"-o", (folder / "x.exr").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("tent.obj:3"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace rayfarm
