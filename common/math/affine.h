// Affine maps of scene space, named to_from: world_from_local maps local points into world space.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "common/math/vec.h"

namespace rayfarm {

/// A scene's vector as the geometry has it.
inline Vec3d vec(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

struct Affine {
  glm::dmat3 linear{1.0};  // column vectors: p' = linear * p + offset
  glm::dvec3 offset{0.0};

  bool operator==(const Affine&) const = default;
};

/// First b, then a.
inline Affine operator*(const Affine& a, const Affine& b) {
  return {a.linear * b.linear, a.linear * b.offset + a.offset};
}
inline glm::dvec3 point(const Affine& m, const glm::dvec3& p) { return m.linear * p + m.offset; }

Affine translation(const glm::dvec3& by);
Affine scaling(const glm::dvec3& by);
/// Rotation about an axis (0 x, 1 y, 2 z), angle in degrees, counter-clockwise seen from the axis' tip in a
/// right-handed frame: RotX = [[1,0,0],[0,c,-s],[0,s,c]]. Exact for multiples of 90 degrees; same bits on every CPU.
Affine rotation_deg(int axis, double degrees);
/// Rotation about any axis through the origin (Rodrigues); the axis need not be unit length, but not zero.
Affine rotation_deg(const glm::dvec3& axis, double degrees);

/// True when the map can be inverted in double precision: all finite, and the determinant not lost in rounding.
bool is_invertible(const Affine& m);

}  // namespace rayfarm
