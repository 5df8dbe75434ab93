// A surface of triangles, as a file gives it. What rays ask of it is derived: see mesh_facets.h.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace rayfarm {

using IndexTriple = std::array<std::uint32_t, 3>;

/// Triangles counter-clockwise as seen from outside. Normals and texture coordinates belong to corners, not to
/// points: at a crease one point has several.
struct TriangleMesh {
  std::vector<Vec3d> points;  // no two alike
  std::vector<IndexTriple> triangles;

  std::vector<Vec3d> normals;           // any length > 0
  std::vector<IndexTriple> normals_at;  // of each triangle's corners; empty: none were given
  std::vector<double> texture;          // u, v, u, v, ...
  std::vector<IndexTriple> texture_at;  // of each triangle's corners; empty: none were given
  bool operator==(const TriangleMesh&) const = default;
};

constexpr std::size_t max_mesh_points = 20'000'000;
constexpr std::size_t max_triangles = 20'000'000;

/// What makes the mesh unusable: indices out of range, numbers that are not finite, nothing at all; empty: nothing.
std::string fault_of(const TriangleMesh& mesh);

/// Whether the triangles enclose a volume: each edge belongs to as many triangles in one direction as in the other.
bool is_closed(const TriangleMesh& mesh);

/// Six times the volume enclosed, negative when the faces look inwards.
double six_volumes(const TriangleMesh& mesh);

}  // namespace rayfarm
