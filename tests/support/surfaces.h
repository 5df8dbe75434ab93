// Small meshes and Bezier surfaces for tests, and what is exactly true of them.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "common/geometry/facets.h"

namespace rayfarm {

/// [0, 1]^3, each face cut in two.
inline TriangleMesh cube_mesh() {
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i) cube.points.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)});
  const std::array<std::array<std::uint32_t, 4>, 6> faces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& [a, b, c, d] : faces)
    cube.triangles.push_back({a, b, c}), cube.triangles.push_back({a, c, d});
  return cube;
}

/// A closed, convex ball of radius 1: rings of quads cut in two, and caps.
inline TriangleMesh ball_mesh(std::uint32_t rings, std::uint32_t columns) {
  constexpr double pi = 3.14159265358979323846;
  TriangleMesh ball;
  ball.points = {{0, 0, -1}};
  for (std::uint32_t ring = 1; ring < rings; ++ring)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const double up = pi * ring / rings, around = 2 * pi * column / columns;
      ball.points.push_back(
          {std::sin(up) * std::cos(around), std::sin(up) * std::sin(around), -std::cos(up)});
    }
  ball.points.push_back({0, 0, 1});
  const auto top = static_cast<std::uint32_t>(ball.points.size() - 1);
  const auto at = [&](std::uint32_t ring, std::uint32_t column) {
    return 1 + (ring - 1) * columns + column % columns;
  };
  for (std::uint32_t column = 0; column < columns; ++column) {
    ball.triangles.push_back({0, at(1, column + 1), at(1, column)});
    for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
      ball.triangles.push_back({at(ring, column), at(ring, column + 1), at(ring + 1, column + 1)});
      ball.triangles.push_back({at(ring, column), at(ring + 1, column + 1), at(ring + 1, column)});
    }
    ball.triangles.push_back({top, at(rings - 1, column), at(rings - 1, column + 1)});
  }
  return ball;
}

/// One patch: a hill over [-2, 2] x [-2, 2], its top at y = 2.25 * 0.75 * 0.75.
inline BezierGrid hill_grid() {
  BezierGrid hill{1, 1, {}};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const bool inner = row % 3 != 0 && column % 3 != 0;
      hill.points.push_back({-2 + 4.0 / 3 * column, inner ? 4.0 : 0.0, 2 - 4.0 / 3 * row});
    }
  return hill;
}

/// A closed, nearly round ball of 2 x 4 patches; its poles are points.
inline BezierGrid ball_grid() {
  constexpr double k = 0.5522847498307936;  // of a quarter circle's control points
  const std::array<std::array<double, 2>, 7> profile{
      {{0, -1}, {k, -1}, {1, -k}, {1, 0}, {1, k}, {k, 1}, {0, 1}}};
  const std::array<std::array<double, 2>, 13> circle{{{1, 0},
                                                      {1, k},
                                                      {k, 1},
                                                      {0, 1},
                                                      {-k, 1},
                                                      {-1, k},
                                                      {-1, 0},
                                                      {-1, -k},
                                                      {-k, -1},
                                                      {0, -1},
                                                      {k, -1},
                                                      {1, -k},
                                                      {1, 0}}};
  BezierGrid ball{2, 4, {}};
  for (const auto& [r, z] : profile)
    for (const auto& [x, y] : circle) ball.points.push_back({r * x, r * y, z});
  return ball;
}

/// The point of a grid at (u, v) in patches from its first corner.
inline Vec3d bezier_point(const BezierGrid& grid, double u, double v) {
  const auto patch = [](double x, std::uint32_t patches) { return std::min(std::floor(x), patches - 1.0); };
  const double column = patch(u, grid.columns), row = patch(v, grid.rows);
  const auto bernstein = [](double x) {
    const double y = 1 - x;
    return std::array<double, 4>{y * y * y, 3 * x * y * y, 3 * x * x * y, x * x * x};
  };
  const std::array<double, 4> by_u = bernstein(u - column), by_v = bernstein(v - row);
  Vec3d sum;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      sum += grid.at(3 * static_cast<std::size_t>(row) + i, 3 * static_cast<std::size_t>(column) + j) *
             (by_v[i] * by_u[j]);
  return sum;
}

/// All crossings of a line, also of a sheet.
inline std::vector<FacetCrossing> crossings_of_line(const Facets& facets, const LocalRay<double>& ray) {
  std::vector<FacetCrossing> found;
  const double endless = infinity;
  std::visit(
      [&](const auto& f) { f.visit(ray, endless, [&](const FacetCrossing& c) { found.push_back(c); }); },
      facets);
  return found;
}

}  // namespace rayfarm
