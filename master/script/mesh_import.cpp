#include "master/script/mesh_import.h"

#include <algorithm>
#include <numeric>

#include "common/scene/scene.h"
#include "master/files/ending.h"

namespace rayfarm {
namespace {

/// Of each point the number of the first one at the same place, counted without the others.
struct Welded {
  std::vector<Vec3d> points;
  std::vector<std::uint32_t> number_of;
};

Welded weld(const std::vector<Vec3d>& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return std::tuple(points[i].x, points[i].y, points[i].z, i); };
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> first_like(points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    first_like[order[i]] =
        i > 0 && points[order[i]] == points[order[i - 1]] ? first_like[order[i - 1]] : order[i];

  Welded welded;
  welded.number_of.resize(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (first_like[i] == i) {
      welded.number_of[i] = static_cast<std::uint32_t>(welded.points.size());
      welded.points.push_back(points[i] + Vec3d{});  // -0 as +0
    } else {
      welded.number_of[i] = welded.number_of[first_like[i]];
    }
  }
  return welded;
}

void turn(TriangleMesh& mesh) {
  for (auto* triples : {&mesh.triangles, &mesh.normals_at, &mesh.texture_at})
    for (IndexTriple& t : *triples) std::swap(t[1], t[2]);
  for (Vec3d& n : mesh.normals) n = -n;
}

}  // namespace

TriangleMesh triangulated(const PolygonMesh& polygons) {
  const Welded welded = weld(polygons.points);
  TriangleMesh mesh;
  mesh.points = welded.points;
  const auto all_have = [&](std::uint32_t PolygonMesh::Corner::*what) {
    return std::ranges::none_of(polygons.corners,
                                [&](const PolygonMesh::Corner& c) { return c.*what == PolygonMesh::none; });
  };
  const bool with_normals = all_have(&PolygonMesh::Corner::normal),
             with_texture = all_have(&PolygonMesh::Corner::texture);
  if (with_normals) mesh.normals = polygons.normals;
  if (with_texture) mesh.texture = polygons.texture;

  std::uint32_t begin = 0;
  for (const std::uint32_t end : polygons.face_ends) {
    const PolygonMesh::Corner& a = polygons.corners[begin];
    for (std::uint32_t i = begin + 1; i + 1 < end; ++i) {
      const PolygonMesh::Corner &b = polygons.corners[i], &c = polygons.corners[i + 1];
      const IndexTriple t{welded.number_of[a.point], welded.number_of[b.point], welded.number_of[c.point]};
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;  // no face
      mesh.triangles.push_back(t);
      if (with_normals) mesh.normals_at.push_back({a.normal, b.normal, c.normal});
      if (with_texture) mesh.texture_at.push_back({a.texture, b.texture, c.texture});
    }
    begin = end;
  }
  if (is_closed(mesh) && six_volumes(mesh) < 0) turn(mesh);
  return mesh;
}

TriangleMesh read_mesh(const std::string& name, std::string_view bytes) {
  const std::string ending = ending_of(name);
  PolygonMesh polygons;
  if (ending == ".obj")
    polygons = read_obj(name, bytes);
  else if (ending == ".ply")
    polygons = read_ply(name, bytes);
  else
    throw SceneError(name + ": a mesh is read from a file that ends in .obj or .ply");
  TriangleMesh mesh = triangulated(polygons);
  if (const std::string fault = fault_of(mesh); !fault.empty()) throw SceneError(name + " " + fault);
  return mesh;
}

}  // namespace rayfarm
