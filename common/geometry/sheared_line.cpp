#include "common/geometry/sheared_line.h"

namespace rayfarm {
namespace {

double inverse_of(double d) { return 1 / (d + 0.0); }  // -0 as +0

int largest_axis(const Vec3d& d) {
  int axis = std::fabs(d.x) >= std::fabs(d.y) ? 0 : 1;
  return std::fabs(d[axis]) >= std::fabs(d.z) ? axis : 2;
}

}  // namespace

ShearedLine::ShearedLine(const LocalRay<double>& ray, double size) : origin_(ray.origin) {
  const Vec3d& d = ray.direction;
  axis_[2] = largest_axis(d);
  axis_[0] = (axis_[2] + 1) % 3, axis_[1] = (axis_[2] + 2) % 3;
  const double along = d[axis_[2]];
  shear_x_ = d[axis_[0]] / along, shear_y_ = d[axis_[1]] / along, per_z_ = 1 / along;
  forward_ = along > 0;

  // With p = point - origin, |p| <= reach: x = p_x - (d_x / d_z) p_z. The origin is off by its error in both terms
  // (|d_x / d_z| <= 1), d_x / d_z by 2 direction_error / |d_z| and a rounding; the operations round four times more.
  const double reach = size + max_abs(origin_),
               slack = ray.direction_error / (std::fabs(along) - ray.direction_error);
  const double rounding = 8 * unit_roundoff * reach;
  const double tilt = slack >= 0 ? 2 * slack : infinity;  // a direction that is all error points anywhere
  across_error_ = 2 * ray.origin_error + tilt * reach + rounding;
  // t = p_z / d_z.
  along_constant_ = (ray.origin_error + unit_roundoff * reach) * std::fabs(per_z_);
  along_relative_ = tilt + 4 * unit_roundoff;
  wide_ = {origin_, {inverse_of(d.x), inverse_of(d.y), inverse_of(d.z)}, 2 * rounding};
}

}  // namespace rayfarm
