#include "common/geometry/mesh_facets.h"

#include <algorithm>

namespace rayfarm {
namespace {

using Place = ShearedLine::Place;

/// The side of the edge p -> q on which the line lies: 1 left, -1 right, exactly; 0 for an edge seen as a point.
int side_of(const Place& p, const Place& q) {
  const double a = p.x * q.y, b = p.y * q.x;
  if (a != b) return a > b ? 1 : -1;
  const double a_rest = std::fma(p.x, q.y, -a), b_rest = std::fma(p.y, q.x, -b);
  if (a_rest != b_rest) return a_rest > b_rest ? 1 : -1;
  // Through the edge: the line counts as moved by (e, e^2), e > 0 smaller than any number.
  if (p.y != q.y) return p.y > q.y ? 1 : -1;
  if (p.x != q.x) return q.x > p.x ? 1 : -1;
  return 0;
}

double cross(const Place& p, const Place& q) { return p.x * q.y - p.y * q.x; }

double across(const Place& p) { return greatest(std::fabs(p.x), std::fabs(p.y)); }

std::vector<Vec3d> area_weighted_normals(const TriangleMesh& mesh) {
  std::vector<Vec3d> normals(mesh.points.size());
  for (const IndexTriple& t : mesh.triangles) {
    const Vec3d& a = mesh.points[t[0]];
    const Vec3d n = cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a);
    for (const std::uint32_t corner : t) normals[corner] += n;
  }
  return normals;
}

bool is_zero(const Vec3d& v) { return v == Vec3d{}; }

Vec3d unit(const Vec3d& v) {
  const double size = max_abs(v);  // first, so that no square leaves the range of numbers
  return size > 0 ? normalized(v * (1 / size)) : v;
}

}  // namespace

MeshFacets::MeshFacets(const TriangleMesh& mesh) : mesh_(mesh), closed_(rayfarm::is_closed(mesh)) {
  std::vector<Box> boxes;
  boxes.reserve(mesh.triangles.size());
  for (const IndexTriple& t : mesh.triangles) {
    Box box;
    for (const std::uint32_t corner : t) box = hull(box, {mesh.points[corner], mesh.points[corner]});
    boxes.push_back(box), box_ = hull(box_, box);
  }
  size_ = greatest(max_abs(box_.low), max_abs(box_.high));
  bvh_ = Bvh(boxes);
  corners_.reserve(boxes.size());
  for (const std::uint32_t number : bvh_.order()) {
    const IndexTriple& t = mesh.triangles[number];
    corners_.push_back({{mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]}});
  }
  if (mesh.normals_at.empty()) point_normals_ = area_weighted_normals(mesh);
}

bool MeshFacets::passes(const ShearedLine& line, const Corners& corners, Passage& passage) {
  Place(&p)[3] = passage.place;
  for (int i = 0; i < 3; ++i) p[i] = line.place_of(corners.at[i]);
  const int side = side_of(p[1], p[2]);
  if (side == 0 || side_of(p[2], p[0]) != side || side_of(p[0], p[1]) != side) return false;
  passage.counter_clockwise = side > 0;
  passage.weight[0] = cross(p[1], p[2]), passage.weight[1] = cross(p[2], p[0]),
  passage.weight[2] = cross(p[0], p[1]);
  passage.sum = passage.weight[0] + passage.weight[1] + passage.weight[2];
  if (passage.sum == 0) passage.weight[0] = passage.sum = 1;  // too thin to tell where
  return true;
}

FacetCrossing MeshFacets::crossing_of(const ShearedLine& line, const Passage& passage, std::uint32_t part) {
  const Place(&p)[3] = passage.place;
  const double second = p[1].t - p[0].t, third = p[2].t - p[0].t;
  const double t = p[0].t + (passage.weight[1] * second + passage.weight[2] * third) / passage.sum;

  // A weight x1 y2 - y1 x2 is off by 4 m e + 2 e^2, coordinates up to m being off by e, and its rounding. The corners
  // pull t by their weights' errors in proportion to their distances along the line; it cannot leave their range.
  const double spread = greatest(std::fabs(second), std::fabs(third)) + std::fabs(second - third);
  const double m = greatest(across(p[0]), greatest(across(p[1]), across(p[2]))), e = line.across_error();
  const double weight_error = 4 * m * e + 2 * e * e + 4 * unit_roundoff * m * m;
  const double sum = std::fabs(passage.sum);
  double pulled = spread;
  if (sum > 6 * weight_error) {
    const double distances = std::fabs(p[0].t - t) + std::fabs(p[1].t - t) + std::fabs(p[2].t - t);
    pulled = least(spread, 2 * weight_error * distances / sum);
  }
  const double error = line.along_error(t) + pulled + unit_roundoff * (8 * spread + 2 * std::fabs(t));
  return {t, error, part, line.enters(passage.counter_clockwise)};
}

Vec3d MeshFacets::normal_at(std::uint32_t triangle, const double (&share)[3]) const {
  Vec3d normal;
  const IndexTriple& at = mesh_.normals_at.empty() ? mesh_.triangles[triangle] : mesh_.normals_at[triangle];
  const std::vector<Vec3d>& normals = mesh_.normals_at.empty() ? point_normals_ : mesh_.normals;
  for (std::size_t i = 0; i < 3; ++i) normal += unit(normals[at[i]]) * share[i];
  return normal;
}

FacetPoint MeshFacets::point_at(const LocalRay<double>& ray, const FacetCrossing& crossing,
                                bool smooth) const {
  const Corners& corners = corners_[crossing.part];
  Passage passage;
  passes(ShearedLine(ray, size_), corners, passage);
  double share[3];
  for (int i = 0; i < 3; ++i) share[i] = least(greatest(passage.weight[i] / passage.sum, 0), 1);

  const std::uint32_t triangle = bvh_.order()[crossing.part];
  const Vec3d &a = corners.at[0], to_b = corners.at[1] - a, to_c = corners.at[2] - a;
  FacetPoint found;
  found.surface.point = a + to_b * share[1] + to_c * share[2];
  // Wrong shares move the point within the triangle's plane; out of it only these roundings.
  found.error = 4 * unit_roundoff * (max_abs(a) + max_abs(to_b) * share[1] + max_abs(to_c) * share[2]);
  if (smooth) found.surface.normal = normal_at(triangle, share);
  if (is_zero(found.surface.normal)) found.surface.normal = unit(cross(unit(to_b), unit(to_c)));
  if (is_zero(found.surface.normal)) found.surface.normal = ray.direction * (crossing.entering ? -1.0 : 1.0);
  if (!mesh_.texture_at.empty())
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t place = 2 * std::size_t{mesh_.texture_at[triangle][i]};
      found.texture.u += mesh_.texture[place] * share[i],
          found.texture.v += mesh_.texture[place + 1] * share[i];
    }
  return found;
}

}  // namespace rayfarm
