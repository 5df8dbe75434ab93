#include "common/geometry/bezier.h"

#include <algorithm>
#include <cmath>

namespace rayfarm {
namespace {

using Curve = std::vector<Vec3d>;

Curve row_of(const BezierGrid& grid, std::size_t row) {
  Curve curve;
  for (std::size_t column = 0; column < grid.width(); ++column) curve.push_back(grid.at(row, column));
  return curve;
}
Curve column_of(const BezierGrid& grid, std::size_t column) {
  Curve curve;
  for (std::size_t row = 0; row < grid.height(); ++row) curve.push_back(grid.at(row, column));
  return curve;
}

bool is_point(const Curve& curve) {
  return std::ranges::all_of(curve, [&](const Vec3d& p) { return p == curve[0]; });
}

/// There and back again: the border is sewn to itself.
bool is_folded(const Curve& curve) { return std::equal(curve.begin(), curve.end(), curve.rbegin()); }

bool meet(const Curve& first, const Curve& last) {
  return first == last || (is_folded(first) && is_folded(last)) || (is_point(first) && is_point(last));
}

}  // namespace

std::string fault_of(const BezierGrid& grid) {
  if (grid.rows == 0 || grid.columns == 0) return "needs at least one patch";
  if (std::uint64_t{grid.rows} * grid.columns > max_patches)
    return "has more than " + std::to_string(max_patches) + " patches";
  if (grid.points.size() != grid.width() * grid.height())
    return "needs " + std::to_string(grid.height()) + " x " + std::to_string(grid.width()) +
           " control points, has " + std::to_string(grid.points.size());
  for (const Vec3d& p : grid.points)
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
      return "has a control point that is not finite";
  return {};
}

bool is_closed(const BezierGrid& grid) {
  return meet(row_of(grid, 0), row_of(grid, grid.height() - 1)) &&
         meet(column_of(grid, 0), column_of(grid, grid.width() - 1));
}

}  // namespace rayfarm
