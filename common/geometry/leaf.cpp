#include "common/geometry/leaf.h"

#include "common/geometry/torus.h"

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

/// Half the extent of the solid's shadow on a world axis, about `middle` (local), given the axis' row.
struct Extent {
  double low, high;
};

Extent about(double middle, double half) { return {middle - half, middle + half}; }

double planar(const Vec3d& row) { return std::sqrt(row.x * row.x + row.y * row.y); }

/// The solid's range along one world axis: local points p give dot(row, p).
Extent extent(const Solid& solid, const Vec3d& row) {
  const double endless = infinity;
  return std::visit(Overload{
                        [&](const Sphere&) { return about(0, length(row)); },
                        [&](const Cube&) {
                          return Extent{least(row.x, 0) + least(row.y, 0) + least(row.z, 0),
                                        greatest(row.x, 0) + greatest(row.y, 0) + greatest(row.z, 0)};
                        },
                        [&](const Plane&) {
                          if (row.x != 0 || row.y != 0) return Extent{-endless, endless};
                          return row.z > 0 ? Extent{-endless, 0} : Extent{0, endless};
                        },
                        [&](const Cylinder& c) {
                          if (row.z == 0) return about(0, planar(row));
                          const double a = row.z * c.z_min, b = row.z * c.z_max;
                          return Extent{least(a, b) - planar(row), greatest(a, b) + planar(row)};
                        },
                        [&](const Torus& t) { return about(0, t.R * planar(row) + t.r * length(row)); },
                    },
                    solid);
}

/// Largest |coordinate| of the solid's local points that matter for the transform's error; unbounded ones are
/// bounded by what they are cut with.
double local_size(const Solid& solid) {
  return std::visit(Overload{
                        [](const Cylinder& c) {
                          const double z = greatest(std::fabs(c.z_min), std::fabs(c.z_max));
                          return z < infinity ? greatest(z, 1) : 1.0;
                        },
                        [](const Torus& t) { return t.R + t.r; },
                        [](const auto&) { return 1.0; },
                    },
                    solid);
}

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
  Box box;
  for (int axis = 0; axis < 3; ++axis)
    put(box, axis, extent(solid, row_of(world_from_local.map.linear, axis)), local_size(solid),
        world_from_local);
  return box;
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
  if (const auto interval = convex_interval(leaf, ray)) return ahead(*interval);
  return torus_crossings(std::get<Torus>(leaf.solid), ray);
}

Crossings crossings_from_surface(const Leaf& leaf, const LocalRay<double>& ray, bool inward) {
  if (const Torus* torus = std::get_if<Torus>(&leaf.solid))
    return torus_crossings_from_surface(*torus, ray, inward);
  // A convex solid is left for good outward; inward there is one crossing, on the far side.
  Crossings found;
  if (!inward) return found;
  found.starts_inside = true;
  const Bounded<double> exit = std::visit(
      Overload{
          [&](const Sphere&) { return sphere_exit_from_surface(ray); },
          [&](const Cylinder& c) { return cylinder_exit_from_surface(c, ray, is_on_cap(c, ray.origin)); },
          [&](const Cube&) { return cube_interval(ray).leave; },
          [&](const auto&) { return bounded(infinity, 0.0); },
      },
      leaf.solid);
  // Grazing inward, the exit can round to the origin or behind it.
  if (exit.t < infinity) found.add(crossing_at(exit.t > 0 ? exit : bounded(0.0, 0.0)));
  return found;
}

SurfacePoint surface_at(const Leaf& leaf, const LocalRay<double>& ray, double t, bool entering) {
  return std::visit(Overload{
                        [&](const Sphere&) { return sphere_surface(ray, entering); },
                        [&](const Cube&) { return cube_surface(ray, t, entering); },
                        [&](const Plane&) { return plane_surface(ray, t); },
                        [&](const Cylinder& c) { return cylinder_surface(c, ray, t, entering); },
                        [&](const Torus& torus) { return torus_surface(torus, ray, t); },
                    },
                    leaf.solid);
}

TextureCoordinates texture_at(const Leaf& leaf, const SurfacePoint& s) {
  return std::visit(Overload{
                        [&](const Sphere&) { return sphere_texture(s.point); },
                        [&](const Cube&) { return cube_texture(s.point, s.normal); },
                        [&](const Plane&) { return plane_texture(s.point); },
                        [&](const Cylinder&) { return cylinder_texture(s.point, s.normal); },
                        [&](const Torus& t) { return torus_texture(t, s.point); },
                    },
                    leaf.solid);
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
