// The solids, each in its local space, and the set operations on them.
#pragma once
#include <cstdint>
#include <limits>
#include <variant>

namespace rayfarm {

struct Sphere {  // unit radius about the origin
  bool operator==(const Sphere&) const = default;
};
struct Cube {  // [0,1]^3
  bool operator==(const Cube&) const = default;
};
struct Plane {  // the half-space z < 0; its face is z = 0
  bool operator==(const Plane&) const = default;
};
struct Cylinder {  // x^2 + y^2 < 1, z_min < z < z_max; infinite limits mean no cap
  double z_min = -std::numeric_limits<double>::infinity();
  double z_max = std::numeric_limits<double>::infinity();
  bool operator==(const Cylinder&) const = default;
};
/// Axis z; the tube's centre runs on the circle of radius R in z = 0, the tube has radius r. Both > 0. A
/// spindle torus (R < r) is the apple without the lemon.
struct Torus {
  double R = 1, r = 0.25;
  bool operator==(const Torus&) const = default;
};
using Solid = std::variant<Sphere, Cube, Plane, Cylinder, Torus>;

enum class CsgOp : std::uint8_t { unite, intersect, subtract, exclusive_or };

}  // namespace rayfarm
