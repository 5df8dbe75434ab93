#include "common/geometry/mesh.h"

#include <algorithm>
#include <cmath>

namespace rayfarm {
namespace {

bool are_finite(const std::vector<Vec3d>& vectors) {
  return std::ranges::all_of(
      vectors, [](const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); });
}

bool are_below(const std::vector<IndexTriple>& triples, std::size_t limit) {
  return std::ranges::all_of(
      triples, [&](const IndexTriple& t) { return t[0] < limit && t[1] < limit && t[2] < limit; });
}

std::string numbers_above(std::size_t count, const std::string& what) {
  return "has more than " + std::to_string(count) + " " + what;
}

}  // namespace

std::string fault_of(const TriangleMesh& m) {
  if (m.triangles.empty()) return "has no triangles";
  if (m.points.size() > max_mesh_points) return numbers_above(max_mesh_points, "points");
  if (m.triangles.size() > max_triangles) return numbers_above(max_triangles, "triangles");
  if (m.normals.size() > 3 * max_triangles) return numbers_above(3 * max_triangles, "normals");
  if (!are_finite(m.points)) return "has a point that is not finite";
  if (!are_finite(m.normals)) return "has a normal that is not finite";
  if (!std::ranges::all_of(m.texture, [](double x) { return std::isfinite(x); }))
    return "has a texture coordinate that is not finite";
  if (!are_below(m.triangles, m.points.size())) return "has a triangle with a point that is not there";
  if (!are_below(m.normals_at, m.normals.size())) return "has a triangle with a normal that is not there";
  if (!are_below(m.texture_at, m.texture.size() / 2))
    return "has a triangle with texture coordinates that are not there";
  const auto fits = [&](const std::vector<IndexTriple>& at) {
    return at.empty() || at.size() == m.triangles.size();
  };
  if (!fits(m.normals_at)) return "gives normals to some triangles only";
  if (!fits(m.texture_at)) return "gives texture coordinates to some triangles only";
  return {};
}

bool is_closed(const TriangleMesh& mesh) {
  // Each directed edge as one number, once as it is and once turned: the two lists must be the same.
  std::vector<std::uint64_t> edges, turned;
  edges.reserve(3 * mesh.triangles.size()), turned.reserve(3 * mesh.triangles.size());
  for (const IndexTriple& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t a = t[i], b = t[(i + 1) % 3];
      if (a == b) continue;
      edges.push_back(a << 32 | b), turned.push_back(b << 32 | a);
    }
  std::ranges::sort(edges);
  std::ranges::sort(turned);
  return edges == turned;
}

double six_volumes(const TriangleMesh& mesh) {
  if (mesh.points.empty()) return 0;
  const Vec3d& about = mesh.points[0];  // near the mesh, so that little cancels
  double sum = 0;
  for (const IndexTriple& t : mesh.triangles)
    sum += dot(mesh.points[t[0]] - about, cross(mesh.points[t[1]] - about, mesh.points[t[2]] - about));
  return sum;
}

}  // namespace rayfarm
