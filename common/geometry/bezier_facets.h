// Lines against a surface of bicubic Bezier patches.
//
// Patches are cut into pieces, whose boxes stand in a hierarchy. In the line's own frame (sheared_line.h) a piece is
// a map of (u, v) to the plane, and the line passes it where that map is 0. A piece whose derivatives keep within two
// cones that do not meet is passed at most once, and Newton's method finds where, to the last bits; any other is
// halved. What is left after many halvings is a tangent, which is no crossing. Sources: T. Nishita, T. W. Sederberg,
// M. Kakimoto, Ray Tracing Trimmed Rational Surface Patches, SIGGRAPH 1990 (the map to the plane); D. L. Toth, On Ray
// Tracing Parametric Surfaces, SIGGRAPH 1985 (Newton where it is sure to find the only root).
#pragma once
#include <array>

#include "common/geometry/bezier.h"
#include "common/geometry/bvh.h"
#include "common/geometry/facet_crossing.h"
#include "common/geometry/sheared_line.h"

namespace rayfarm {

/// Row by row, u along a row.
using BezierNet = std::array<Vec3d, 16>;

class BezierFacets {
 public:
  /// The grid must be without fault, and outlive the facets.
  explicit BezierFacets(const BezierGrid& grid);

  const Box& box() const { return box_; }
  bool is_closed() const { return closed_; }

  /// As MeshFacets::visit(); what is outside of a closed surface is its front. The part is the piece's place in the hierarchy. A line through a border of pieces may be
  /// found in each of them.
  template <class Found>
  void visit(const LocalRay<double>& ray, const double& t_max, Found&& found) const;

  FacetPoint point_at(const LocalRay<double>& ray, const FacetCrossing& crossing) const;

 private:
  struct Piece {
    std::uint32_t patch;
    double u0, v0;  // of its corner, in its patch
    BezierNet net;
  };
  struct Root {
    FacetCrossing crossing;
    double u, v;  // in the piece
  };
  struct Roots {
    static constexpr int most = 18;  // a line meets a bicubic patch no more often
    int count = 0;
    std::array<Root, most> at;
  };
  class Search;

  BezierNet net_of(std::uint32_t patch) const;
  void cut_into_pieces();
  bool looks_inwards() const;
  Roots roots_of(const ShearedLine& line, std::uint32_t place, double t_max) const;

  const BezierGrid& grid_;
  bool closed_;
  bool turned_ = false;  // closed, and the front of its patches looks inwards
  Box box_;
  double size_ = 0;    // largest |coordinate| of control points
  int pieces_a_side_;  // of a patch
  Bvh bvh_;
  std::vector<Piece> pieces_;  // in the order of the hierarchy
};

template <class Found>
void BezierFacets::visit(const LocalRay<double>& ray, const double& t_max, Found&& found) const {
  const ShearedLine line(ray, size_);
  bvh_.visit(line.wide(), t_max, [&](std::uint32_t place) {
    const Roots roots = roots_of(line, place, t_max);
    for (int i = 0; i < roots.count; ++i) {
      FacetCrossing crossing = roots.at[static_cast<std::size_t>(i)].crossing;
      crossing.entering = crossing.entering != turned_;
      found(crossing);
    }
    return true;
  });
}

}  // namespace rayfarm
