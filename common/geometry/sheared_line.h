// A line's own frame, in which it is the z axis: what a triangle or patch is to it shows in two coordinates.
// Source: S. Woop, C. Benthin, I. Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013.
#pragma once
#include "common/geometry/bounds.h"
#include "common/geometry/ray.h"

namespace rayfarm {

/// A point has the same place whatever surface it is asked for.
class ShearedLine {
 public:
  /// size: the largest |coordinate| of points that will be placed.
  ShearedLine(const LocalRay<double>& ray, double size);

  struct Place {
    double x, y, t;  // across the line; along it, as the ray's parameter
  };
  Place place_of(const Vec3d& point) const {
    const Vec3d p = point - origin_;
    const double z = p[axis_[2]];
    return {p[axis_[0]] - shear_x_ * z, p[axis_[1]] - shear_y_ * z, z * per_z_};
  }
  double speed() const { return 1 / std::fabs(per_z_); }  // length along the last axis for 1 of t
  double across_error() const { return across_error_; }   // of x and y
  double along_error(double t) const { return along_constant_ + std::fabs(t) * along_relative_; }  // of t

  /// Whether a surface is entered that shows its corners counter-clockwise (true) or clockwise in x and y.
  bool enters(bool counter_clockwise) const { return counter_clockwise != forward_; }

  /// Finds all boxes with points at x = y = 0.
  const WideLine& wide() const { return wide_; }

 private:
  Vec3d origin_;
  int axis_[3];  // the last one is that of the direction's largest component
  double shear_x_, shear_y_, per_z_;
  double across_error_, along_constant_, along_relative_;
  bool forward_;  // along the last axis
  WideLine wide_;
};

}  // namespace rayfarm
