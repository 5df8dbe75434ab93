// Meshes from files: all forms of the same mesh give the same one, and broken files say where they are broken.
#include "master/script/mesh_import.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "common/scene/scene.h"

namespace rayfarm {
namespace {

/// [0, 1]^3, its faces as quads that look outwards.
constexpr const char* cube_obj = R"(# a cube
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";

std::string complaint(const std::string& name, std::string_view bytes) {
  try {
    read_mesh(name, bytes);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

/// The cube as PLY; each number goes through put(text, value).
enum class Form { ascii, little, big };
std::string cube_ply(Form form) {
  const std::array<const char*, 3> names{"ascii", "binary_little_endian", "binary_big_endian"};
  std::string ply =
      std::string("ply\nformat ") + names[static_cast<std::size_t>(form)] +
      " 1.0\ncomment a cube\nelement vertex 8\nproperty float x\nproperty double y\nproperty float z\n"
      "property uchar red\nelement face 6\nproperty list uchar int vertex_indices\n"
      "property list uchar short others\nelement edge 1\nproperty int vertex1\nend_header\n";
  const auto put = [&](double value, auto type) {
    using T = decltype(type);
    if (form == Form::ascii) {
      ply += std::to_string(static_cast<T>(value)) + "\n";
      return;
    }
    char bytes[sizeof(T)];
    const T typed = static_cast<T>(value);
    std::memcpy(bytes, &typed, sizeof(T));
    if (form == Form::big) std::reverse(bytes, bytes + sizeof(T));
    ply.append(bytes, sizeof(T));
  };
  for (const auto& [x, y, z] : std::initializer_list<std::array<int, 3>>{
           {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}})
    put(x, float{}), put(y, double{}), put(z, float{}), put(200, std::uint8_t{});
  for (const auto& face : std::initializer_list<std::array<int, 4>>{
           {0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}) {
    put(4, std::uint8_t{});
    for (const int corner : face) put(corner, std::int32_t{});
    put(2, std::uint8_t{}), put(-1, std::int16_t{}), put(7, std::int16_t{});
  }
  put(5, std::int32_t{});
  return ply;
}

TEST(MeshImport, ACubeIsClosedAndLooksOutwards) {
  const TriangleMesh cube = read_mesh("cube.obj", cube_obj);
  EXPECT_EQ(cube.points.size(), 8u);
  EXPECT_EQ(cube.triangles.size(), 12u);
  EXPECT_TRUE(is_closed(cube));
  EXPECT_EQ(six_volumes(cube), 6);
}

TEST(MeshImport, AllFormsOfPlyAreTheSameMesh) {
  const TriangleMesh cube = read_mesh("cube.obj", cube_obj);
  for (const Form form : {Form::ascii, Form::little, Form::big})
    EXPECT_EQ(read_mesh("cube.ply", cube_ply(form)), cube) << static_cast<int>(form);
}

TEST(MeshImport, PointsAtTheSamePlaceAreOneAndAClosedMeshIsTurnedOutwards) {
  const std::string faces =
      "v 0 0 0\nv 0 1 0\nv 1 0 0\nf -3 -1 -2\n"  // each face brings points of its own, and looks inwards
      "v 0 0 0\nv 0 0 1\nv 0 1 0\nf -3 -1 -2\n"
      "v 0 0 0\nv 1 0 0\nv 0 0 1\nf -3 -1 -2\n"
      "v 1 0 0\nv 0 1 0\nv 0 0 1\nf -3 -1 -2\n";
  const TriangleMesh mesh = read_mesh("t.obj", faces);
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_EQ(six_volumes(mesh), 1);
}

TEST(MeshImport, NormalsAndTextureCoordinatesBelongToCorners) {
  const TriangleMesh mesh =
      read_mesh("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0.5\nvn 0 0 2\nf 1/1/1 2/2/1 3/1/1\n");
  EXPECT_EQ(mesh.normals, (std::vector<Vec3d>{{0, 0, 2}}));
  EXPECT_EQ(mesh.normals_at, (std::vector<IndexTriple>{{0, 0, 0}}));
  EXPECT_EQ(mesh.texture, (std::vector<double>{0, 0, 1, 0.5}));
  EXPECT_EQ(mesh.texture_at, (std::vector<IndexTriple>{{0, 1, 0}}));
}

TEST(MeshImport, AByteOrderMarkIsNoPartOfTheFirstLine) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(complaint("a.obj", "\xEF\xBB\xBF" + points), "");
}

TEST(MeshImport, ABrokenObjSaysWhere) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(complaint("a.obj", "v 0 0\n"), "a.obj:1: a point needs 3 numbers, has 2");
  EXPECT_EQ(complaint("a.obj", "v 0 0 nan\n"), "a.obj:1: \"nan\" is no finite number");
  EXPECT_EQ(complaint("a.obj", points + "v 0 1e999 0\n"), "a.obj:4: \"1e999\" is no finite number");
  EXPECT_EQ(complaint("a.obj", points + "f 1 2\n"), "a.obj:4: a face needs 3 corners, has 2");
  EXPECT_EQ(complaint("a.obj", points + "f 1 2 4\n"), "a.obj:4: names point 4, but the file has 3");
  EXPECT_EQ(complaint("a.obj", points + "f 1 2 -4\n"),
            "a.obj:4: names point -4, but there are only 3 before");
  EXPECT_EQ(complaint("a.obj", points + "f 1 2 x\n"), "a.obj:4: \"x\" is no number of point");
  EXPECT_EQ(complaint("a.obj", points + "f 1//1 2//1 3//1\n"), "a.obj:4: names normal 1, but the file has 0");
  EXPECT_EQ(complaint("a.obj", points + "v\v0 0 1\nf 1 2 4\n"), "a.obj:4: is no text");
  EXPECT_EQ(complaint("a.obj", points + "# \rf 1 2 9\n"), "a.obj:4: is no text");
  EXPECT_EQ(complaint("a.obj", points), "a.obj has no triangles");
  EXPECT_EQ(complaint("a.stl", points), "a.stl: a mesh is read from a file that ends in .obj or .ply");
}

TEST(MeshImport, ABrokenPlySaysWhere) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ(complaint("a.ply", head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "");
  EXPECT_NE(
      complaint("a.ply",
                "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement "
                "vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0 0 "
                "0\n1 0 0\n0 1 0\n")
          .find("write element vertex first"),
      std::string::npos);
  EXPECT_EQ(complaint("a.ply", head + "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n"),
            "a.ply:12: a vertex has a number that is not finite");
  EXPECT_EQ(complaint("a.ply", head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "a.ply:13: a face names vertex 3, but the file has 3, counted from 0");
  EXPECT_EQ(complaint("a.ply", head + "0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), "a.ply:14: the file ends too early");
  EXPECT_EQ(complaint("a.ply", head + "0 0 0\n1 0 0\n0 1 0\n2 0 1 2\n"),
            "a.ply:13: a face needs 3 corners, has 2");
  EXPECT_EQ(complaint("a.ply", "solid\n"), "a.ply:2: is no PLY file: its first line must be ply");
  const std::string cut = cube_ply(Form::little);
  for (std::size_t size = 0; size < cut.size(); size += 7)
    EXPECT_NE(complaint("a.ply", std::string_view(cut).substr(0, size)), "") << size;
}

TEST(MeshImport, AHeaderThatPromisesMoreThanTheFileHoldsTakesNoMemory) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1000000000\nproperty list uchar int vertex_indices\n"
      "end_header\n";
  EXPECT_EQ(complaint("a.ply", head + std::string(100, '\0')),
            "a.ply:10: the header announces 1000000000 of face, but the file has room for at most 101");
}

}  // namespace
}  // namespace rayfarm
