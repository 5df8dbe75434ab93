#include "common/geometry/leaf.h"

namespace rayfarm {
namespace {

glm::dmat3 magnitude(const glm::dmat3& m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

Vec3d row_of(const glm::dmat3& m, int row) { return {m[0][row], m[1][row], m[2][row]}; }
double row_sum(const glm::dmat3& m, int row) {
  return std::fabs(m[0][row]) + std::fabs(m[1][row]) + std::fabs(m[2][row]);
}

glm::dmat3 adjugate(const glm::dmat3& m) {
  return glm::transpose(glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])));
}

/// One entry, a power of two: an axis turned by right angles or scaled without rounding.
bool is_exact(const glm::dvec3& column) {
  int entries = 0;
  bool powers = true;
  for (int row = 0; row < 3; ++row) {
    int exponent = 0;
    entries += column[row] != 0;
    powers = powers && (column[row] == 0 || std::fabs(std::frexp(column[row], &exponent)) == 0.5);
  }
  return entries == 1 && powers;
}

}  // namespace

BoundedAffine bounded(const Affine& map) {
  // A few rotations and scales multiplied in the script: each rounds relative to its row or column.
  constexpr double relative = 8 * unit_roundoff;
  BoundedAffine b{map};
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      const glm::dvec3 c = glm::abs(map.linear[column]);
      const double column_size = greatest(c.x, greatest(c.y, c.z));
      b.linear_error[column][row] = relative * least(column_size, max_abs(row_of(map.linear, row)));
    }
    if (is_exact(map.linear[column])) b.linear_error[column] = glm::dvec3(0.0);
  }
  b.offset_error = glm::dvec3(relative * max_abs(vec(map.offset)));
  return b;
}

BoundedAffine operator*(const BoundedAffine& a, const BoundedAffine& b) {
  constexpr double rounding = gamma_bound(4);
  const glm::dmat3 la = magnitude(a.map.linear), lb = magnitude(b.map.linear);
  const glm::dvec3 offset = glm::abs(b.map.offset);
  BoundedAffine product{a.map * b.map};
  product.linear_error = a.linear_error * (lb + b.linear_error) + la * b.linear_error + (la * lb) * rounding;
  product.offset_error = a.linear_error * (offset + b.offset_error) + la * b.offset_error + a.offset_error +
                         (la * offset + glm::abs(a.map.offset)) * rounding;
  return product;
}

BoundedAffine inverse(const BoundedAffine& m) {
  const glm::dmat3& l = m.map.linear;
  const double determinant = glm::dot(l[0], glm::cross(l[1], l[2]));
  BoundedAffine out;
  out.map.linear = adjugate(l) * (1 / determinant);
  out.map.offset = -(out.map.linear * m.map.offset);
  // First order: the inverse moves by A E A; its own rounding is that of solving with |A||L||A|.
  const glm::dmat3 a = magnitude(out.map.linear), size = magnitude(l);
  out.linear_error = a * m.linear_error * a + (a * size * a) * gamma_bound(8);
  const glm::dvec3 offset = glm::abs(m.map.offset);
  out.offset_error = out.linear_error * offset + a * m.offset_error + (a * offset) * gamma_bound(4);
  return out;
}

Leaf make_leaf(const Solid& solid, const BoundedAffine& world_from_local) {
  const BoundedAffine local = inverse(world_from_local);
  Leaf leaf{};
  leaf.solid = solid;
  leaf.offset = vec(local.map.offset);
  // A line in a face of two solids must be inside one of them: both see it moved to the same side. The direction
  // is one that no face is likely to hold.
  const Vec3d world_aside{0.8017, 0.5345, 0.2673};
  constexpr double rounding = gamma_bound(4);
  for (int i = 0; i < 3; ++i) {
    leaf.row[i] = row_of(local.map.linear, i);
    leaf.aside[i] = dot(leaf.row[i], world_aside);
    const double stretch = row_sum(local.map.linear, i);
    leaf.stretch = greatest(leaf.stretch, stretch);
    leaf.error_per_size = greatest(leaf.error_per_size, row_sum(local.linear_error, i) + rounding * stretch);
    leaf.error_constant =
        greatest(leaf.error_constant, local.offset_error[i] + rounding * std::fabs(local.map.offset[i]));
  }
  return leaf;
}

namespace {

/// A range along a world axis, with the transform's error for local points of that size.
void put(Box& box, int axis, const Extent& e, double size, const BoundedAffine& m) {
  const double offset = m.map.offset[axis];
  const double by =
      row_sum(m.linear_error, axis) * size + m.offset_error[axis] + 4 * unit_roundoff * std::fabs(offset);
  box.low[axis] = e.low + offset - by - 8 * unit_roundoff * std::fabs(e.low);
  box.high[axis] = e.high + offset + by + 8 * unit_roundoff * std::fabs(e.high);
}

}  // namespace

Box bounds_of(const Solid& solid, const BoundedAffine& world_from_local) {
  return std::visit(
      [&](const auto& s) {
        Box box;
        for (int axis = 0; axis < 3; ++axis)
          put(box, axis, extent_of(s, row_of(world_from_local.map.linear, axis)), size_of(s),
              world_from_local);
        return box;
      },
      solid);
}

Box moved(const Box& box, const BoundedAffine& by) {
  if (box.is_empty()) return box;
  double size = 0;  // of finite coordinates; an infinite one stays infinite whatever its error
  for (int i = 0; i < 3; ++i)
    for (const double x : {box.low[i], box.high[i]})
      if (std::fabs(x) < infinity) size = greatest(size, std::fabs(x));
  Box result;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d row = row_of(by.map.linear, axis);
    Extent e{0, 0};
    for (int i = 0; i < 3; ++i) {
      if (row[i] == 0) continue;  // also where the box is endless
      const double a = row[i] * box.low[i], b = row[i] * box.high[i];
      e.low += least(a, b), e.high += greatest(a, b);
    }
    put(result, axis, e, size, by);
  }
  return result;
}

Crossings crossings(const Leaf& leaf, const LocalRay<double>& ray) {
  return std::visit(
      [&]<class S>(const S& solid) {
        if constexpr (ConvexSolid<S>)
          return ahead(interval_of(solid, ray));
        else
          return crossings_of(solid, ray);
      },
      leaf.solid);
}

namespace {

/// A convex solid is left for good outward; inward there is one crossing, on the far side.
template <ConvexSolid S>
Crossings crossings_from_surface(const S& solid, const LocalRay<double>& ray, bool inward) {
  Crossings found;
  if (!inward) return found;
  found.starts_inside = true;
  const Bounded<double> exit = exit_from_surface(solid, ray);
  // Grazing inward, the exit can round to the origin or behind it.
  if (exit.t < infinity) found.add(crossing_at(exit.t > 0 ? exit : bounded(0.0, 0.0)));
  return found;
}

}  // namespace

Crossings crossings_from_surface(const Leaf& leaf, const LocalRay<double>& ray, bool inward) {
  return std::visit([&](const auto& solid) { return crossings_from_surface(solid, ray, inward); },
                    leaf.solid);
}

SurfacePoint surface_at(const Leaf& leaf, const LocalRay<double>& ray, double t, bool entering) {
  return std::visit([&](const auto& solid) { return surface_of(solid, ray, t, entering); }, leaf.solid);
}

TextureCoordinates texture_at(const Leaf& leaf, const SurfacePoint& s) {
  return std::visit([&](const auto& solid) { return texture_of(solid, s); }, leaf.solid);
}

WorldPoint to_world(const BoundedAffine& world_from_local, const Vec3d& local) {
  const Affine& m = world_from_local.map;
  const glm::dvec3 p{local.x, local.y, local.z}, size = glm::abs(p);
  // The point is within a few ulp of the surface in local space; then the map's error and its rounding.
  const glm::dvec3 error = (magnitude(m.linear) * gamma_bound(8) + world_from_local.linear_error) * size +
                           world_from_local.offset_error + glm::abs(m.offset) * gamma_bound(4);
  return {vec(point(m, p)), max_abs(vec(error))};
}

Vec3d normal_to_world(const Leaf& leaf, const Vec3d& n) {
  return normalized(leaf.row[0] * n.x + leaf.row[1] * n.y + leaf.row[2] * n.z);
}

}  // namespace rayfarm
