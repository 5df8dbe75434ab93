// Triangle meshes from the bytes of OBJ and PLY files. Called in the limited child only: the bytes come from anywhere.
//
// Numbers that are none, lists that end too early and indices of what is not there are errors, with the line; a count
// in a header is believed as far as the bytes that follow can bear it out. Points at the same place become one, so a
// mesh is closed if its faces meet; a closed mesh whose faces look inwards is turned.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "common/geometry/mesh.h"

namespace rayfarm {

/// Faces with any number of corners, as files have them.
struct PolygonMesh {
  struct Corner {
    std::uint32_t point;
    std::uint32_t normal = none, texture = none;
  };
  static constexpr std::uint32_t none = 0xffffffff;

  std::vector<Vec3d> points, normals;
  std::vector<double> texture;  // u, v, ...
  std::vector<Corner> corners;
  std::vector<std::uint32_t> face_ends;  // of each face: the number of corners up to its end
};

/// `name` ends in .obj or .ply and stands in messages. Throws SceneError.
TriangleMesh read_mesh(const std::string& name, std::string_view bytes);

/// Its readers.
PolygonMesh read_obj(const std::string& name, std::string_view bytes);
PolygonMesh read_ply(const std::string& name, std::string_view bytes);

/// Polygons are cut into fans. Normals and texture coordinates count if all corners have them.
TriangleMesh triangulated(const PolygonMesh& polygons);

}  // namespace rayfarm
