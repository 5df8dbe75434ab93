// A surface of bicubic Bezier patches, as a script gives it. What rays ask of it is derived: see bezier_facets.h.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace rayfarm {

/// rows x columns patches over a grid of (3 rows + 1) x (3 columns + 1) control points, row by row. Patches share the
/// points of their common borders. u runs along a row, v from row to row; the front is where dP/du x dP/dv points.
struct BezierGrid {
  std::uint32_t rows = 0, columns = 0;
  std::vector<Vec3d> points;

  std::size_t width() const { return 3 * std::size_t{columns} + 1; }
  std::size_t height() const { return 3 * std::size_t{rows} + 1; }
  const Vec3d& at(std::size_t row, std::size_t column) const { return points[row * width() + column]; }
  bool operator==(const BezierGrid&) const = default;
};

constexpr std::uint32_t max_patches = 100'000;

/// What makes the grid unusable; empty: nothing.
std::string fault_of(const BezierGrid& grid);

/// Whether the surface encloses a volume: its opposite borders are the same curve, or shrink to a point each.
bool is_closed(const BezierGrid& grid);

}  // namespace rayfarm
