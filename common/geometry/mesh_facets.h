// Lines against a triangle mesh, watertight.
//
// The points are sheared into a frame in which the line is the z axis, each in the same way whatever triangle it
// belongs to; there a triangle is passed if the signs of its three edge functions agree. The signs are exact, and a
// line through an edge or a point counts as moved aside by an infinitely small step, the same one for all triangles:
// so a line that comes into a closed mesh also leaves it, without exception. Source: S. Woop, C. Benthin, I. Wald,
// Watertight Ray/Triangle Intersection, JCGT 2(1), 2013; the exact signs by T. J. Dekker's product (fma); the step
// aside after H. Edelsbrunner and E. P. Muecke, Simulation of Simplicity, TOG 9(1), 1990.
#pragma once
#include "common/geometry/bvh.h"
#include "common/geometry/facet_crossing.h"
#include "common/geometry/mesh.h"
#include "common/geometry/sheared_line.h"

namespace rayfarm {

class MeshFacets {
 public:
  /// The mesh must be without fault, and outlive the facets.
  explicit MeshFacets(const TriangleMesh& mesh);

  const Box& box() const { return box_; }
  bool is_closed() const { return closed_; }

  /// Calls found(FacetCrossing) for each triangle that the line passes and that may lie at 0 <= t <= t_max, which
  /// found() may lower. The part is the triangle's place in the hierarchy.
  template <class Found>
  void visit(const LocalRay<double>& ray, const double& t_max, Found&& found) const;

  FacetPoint point_at(const LocalRay<double>& ray, const FacetCrossing& crossing, bool smooth) const;

 private:
  struct Corners {
    Vec3d at[3];
  };
  /// How a line passes a triangle: the weights of the corners have one sign, up to their rounding.
  struct Passage {
    ShearedLine::Place place[3];
    double weight[3];
    double sum;
    bool counter_clockwise;
  };
  static bool passes(const ShearedLine& line, const Corners& corners, Passage& passage);
  static FacetCrossing crossing_of(const ShearedLine& line, const Passage& passage, std::uint32_t part);
  Vec3d normal_at(std::uint32_t triangle, const double (&weight)[3]) const;

  const TriangleMesh& mesh_;
  Box box_;
  double size_;  // largest |coordinate|
  bool closed_;
  Bvh bvh_;
  std::vector<Corners> corners_;      // in the order of the hierarchy
  std::vector<Vec3d> point_normals_;  // by point, when the mesh gives none
};

template <class Found>
void MeshFacets::visit(const LocalRay<double>& ray, const double& t_max, Found&& found) const {
  const ShearedLine line(ray, size_);
  bvh_.visit(line.wide(), t_max, [&](std::uint32_t place) {
    Passage passage;
    if (passes(line, corners_[place], passage)) found(crossing_of(line, passage, place));
    return true;
  });
}

}  // namespace rayfarm
