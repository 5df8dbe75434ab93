#include "common/geometry/leaf.h"

#include <bit>

#include "common/math/hash.h"

namespace rayfarm {
namespace {

glm::dmat3 magnitude(const glm::dmat3& m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

Vec3d row_of(const glm::dmat3& m, int row) { return {m[0][row], m[1][row], m[2][row]}; }
double row_sum(const glm::dmat3& m, int row) {
  return std::fabs(m[0][row]) + std::fabs(m[1][row]) + std::fabs(m[2][row]);
}

glm::dmat3 inverse(const glm::dmat3& m) {
  const glm::dvec3 x = glm::cross(m[1], m[2]), y = glm::cross(m[2], m[0]), z = glm::cross(m[0], m[1]);
  return glm::transpose(glm::dmat3(x, y, z)) * (1 / glm::dot(m[0], x));
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

namespace {

bool is_exact(const glm::dmat3& m) { return is_exact(m[0]) && is_exact(m[1]) && is_exact(m[2]); }

}  // namespace

BoundedAffine operator*(const BoundedAffine& a, const BoundedAffine& b) {
  // Turns by right angles and powers of two are not rounded; so a node that places nothing costs nothing.
  const bool exact = is_exact(a.map.linear) || is_exact(b.map.linear);
  const bool exact_offset = is_exact(a.map.linear) && a.map.offset == glm::dvec3(0.0);
  const double rounding = exact ? 0 : gamma_bound(4), offset_rounding = exact_offset ? 0 : gamma_bound(4);
  const glm::dmat3 la = magnitude(a.map.linear), lb = magnitude(b.map.linear);
  const glm::dvec3 offset = glm::abs(b.map.offset);
  BoundedAffine product{a.map * b.map};
  product.linear_error = a.linear_error * (lb + b.linear_error) + la * b.linear_error + (la * lb) * rounding;
  product.offset_error = a.linear_error * (offset + b.offset_error) + la * b.offset_error + a.offset_error +
                         (la * offset + glm::abs(a.map.offset)) * offset_rounding;
  return product;
}

namespace {

Vec3d absolute(const Vec3d& v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }

/// The offset that takes the local origin's place in world space to 0, for the rounded rows that they are: then what
/// the rows are off by matters over the solid's size only.
void set_offset(Leaf& leaf, const glm::dvec3& centre) {
  for (int i = 0; i < 3; ++i) {
    const DoubleDouble offset = -dot(precise(leaf.row[i]), precise(vec(centre)));
    leaf.offset[i] = offset.hi, leaf.precise.offset_rest[i] = offset.lo;
  }
}

/// By how much row i differs from that of the exact inverse, in each component of row * L.
Vec3d residual_of(const Vec3d& row, int i, const glm::dmat3& world_from_local) {
  Vec3d residual;
  for (int k = 0; k < 3; ++k) {
    const DoubleDouble product = dot(precise(row), precise(vec(world_from_local[k])));
    residual[k] = std::fabs((product - DoubleDouble{k == i ? 1.0 : 0.0}).hi);
  }
  return residual;
}

/// The largest |coordinate| of its points.
double size_of(const Box& box) { return greatest(max_abs(box.low), max_abs(box.high)); }

bool is_endless(const Solid& solid) {
  const auto reaches_out = [](const auto& s, const Vec3d& axis) {
    const Extent e = extent_of(s, axis);
    return e.low == -infinity || e.high == infinity;
  };
  return std::visit(
      [&](const auto& s) {
        return reaches_out(s, {1, 0, 0}) || reaches_out(s, {0, 1, 0}) || reaches_out(s, {0, 0, 1});
      },
      solid);
}

/// Bounds on one local axis, of what is not rounding: the solid's place, and a direction per its size in the world.
struct Uncertainty {
  double place, turn;
};

/// A local point p is seen at p - row E p - row e - r p: E and e the map's own uncertainty, r what the row lacks of the
/// exact inverse.
Uncertainty uncertainty(const Vec3d& row, const Vec3d& residual, const BoundedAffine& m, double size,
                        const Vec3d& stretch) {
  const Vec3d reach = absolute(row);
  Vec3d at_size, of_direction;
  for (int j = 0; j < 3; ++j) {
    at_size[j] = row_sum(m.linear_error, j) * size + m.offset_error[j];
    of_direction[j] = dot(row_of(m.linear_error, j), stretch);
  }
  return {dot(reach, at_size) + (residual.x + residual.y + residual.z) * size,
          dot(reach, of_direction) + dot(residual, stretch)};
}

/// The largest of each, and into share what part of it each axis has.
double largest(const Vec3d& of_axes, Vec3d& share) {
  const double most = max_abs(of_axes);
  for (int i = 0; i < 3; ++i)
    if (most > 0) share[i] = greatest(share[i], of_axes[i] / most);
  return most;
}

/// Up to which RayQuery::size a ray is off by less than 2^-30 in local space, at its origin and wherever it passes the
/// solid, its direction by so much of its length. In the worst case the direction is that which the map shortens most.
double sure_size(const Leaf& leaf, const BoundedAffine& world_from_local) {
  constexpr double most = 0x1p-30;
  const glm::dmat3& m = world_from_local.map.linear;
  // 1 / |d| is at most this for a world direction of size 1, with room for rounding.
  const double shortening = 2 * greatest(row_sum(m, 0), greatest(row_sum(m, 1), row_sum(m, 2)));
  const double reach = max_abs(leaf.offset) + 1;
  // What the origin's local size brings: its rounding in the closest approach, and the direction's over so long a way.
  const double per_reach = 6 * unit_roundoff + 2 * leaf.error_per_size * shortening;
  const double per_size = leaf.error_per_size + leaf.stretch * (0x1p-46 + per_reach);
  const double rest = most - leaf.origin_error - reach * per_reach;
  return leaf.spread_per_size * shortening < most ? rest / per_size : -1;
}

}  // namespace

Leaf make_leaf(const Solid& solid, const BoundedAffine& world_from_local, const Facets* facets) {
  const glm::dmat3 rows = inverse(world_from_local.map.linear);
  const glm::dvec3& centre = world_from_local.map.offset;
  const double size =
      facets ? size_of(box_of(*facets)) : std::visit([](const auto& s) { return size_of(s); }, solid);
  // A line in a face of two solids must be inside one of them: both see it moved to the same side. The direction
  // is one that no face is likely to hold.
  const Vec3d world_aside{0.8017, 0.5345, 0.2673};
  Leaf leaf{};
  leaf.solid = solid, leaf.facets = facets;
  Vec3d stretch;
  for (int i = 0; i < 3; ++i) {
    leaf.row[i] = row_of(rows, i);
    leaf.aside[i] = dot(leaf.row[i], world_aside);
    stretch[i] = row_sum(rows, i);
  }
  set_offset(leaf, centre);

  const bool endless = !facets && is_endless(solid);
  Vec3d place, placed, per_size, turn, spread;
  Leaf::Precise& precise = leaf.precise;
  for (int i = 0; i < 3; ++i) {
    const Vec3d residual = residual_of(leaf.row[i], i, world_from_local.map.linear);
    const Uncertainty u = uncertainty(leaf.row[i], residual, world_from_local, size, stretch);
    place[i] = u.place + (endless ? u.turn * max_abs(vec(centre)) : 0);
    turn[i] = u.turn;
    const double rounding = gamma_bound(4) * stretch[i];
    placed[i] = place[i] + gamma_bound(2) * std::fabs(leaf.offset[i]);
    per_size[i] = rounding + (endless ? u.turn : 0);
    spread[i] = rounding + u.turn;
  }
  precise.origin_error = max_abs(place);
  precise.spread_per_size = max_abs(turn);
  precise.error_per_size = endless ? precise.spread_per_size : 0;
  leaf.origin_error = largest(placed, leaf.share);
  leaf.error_per_size = largest(per_size, leaf.share);
  leaf.spread_per_size = largest(spread, leaf.share);
  leaf.stretch = largest(stretch, leaf.share);
  leaf.sure_size = static_cast<float>(least(sure_size(leaf, world_from_local) * 0.99, 1e30));
  return leaf;
}

bool are_twins(const Leaf& a, const Leaf& b) {
  return a.solid == b.solid && std::equal(a.row, a.row + 3, b.row) && a.offset == b.offset;
}

std::uint64_t twin_hash(const Leaf& leaf) {
  std::uint64_t hash = leaf.solid.index();
  for (const Vec3d& v : {leaf.row[0], leaf.row[1], leaf.row[2], leaf.offset})
    for (int i = 0; i < 3; ++i) hash = keyed(hash, std::bit_cast<std::uint64_t>(v[i] + 0.0));  // -0 as +0
  return hash;
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

Box bounds_of(const Solid& solid, const BoundedAffine& world_from_local, const Facets* facets) {
  if (facets) return moved(box_of(*facets), world_from_local);
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

Placement make_placement(const BoundedAffine& m) {
  // The point is within a few ulp of the surface in local space; then the map's error and its rounding.
  return {m.map, magnitude(m.map.linear) * gamma_bound(8) + m.linear_error,
          m.offset_error + glm::abs(m.map.offset) * gamma_bound(4)};
}

WorldPoint to_world(const Placement& placement, const Vec3d& local) {
  const glm::dvec3 p{local.x, local.y, local.z};
  const glm::dvec3 error = placement.error_per_size * glm::abs(p) + placement.error;
  return {vec(point(placement.map, p)), max_abs(vec(error))};
}

WorldPoint to_world(const Placement& placement, const FacetPoint& local) {
  WorldPoint found = to_world(placement, local.surface.point);
  const glm::dmat3 size = magnitude(placement.map.linear) + placement.error_per_size;
  found.error += local.error * greatest(row_sum(size, 0), greatest(row_sum(size, 1), row_sum(size, 2)));
  return found;
}

}  // namespace rayfarm
