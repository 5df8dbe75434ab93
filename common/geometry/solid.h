// The solids, each in its local space, and the set operations on them.
//
// A solid names itself and its numbers for people, and says what faces it has; what a ray meets of it
// stands in a header of its own (solids.h lists them).
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <variant>

namespace rayfarm {

struct NamedNumber {
  const char* name;
  double value;
};

/// What tells two points of its surface to be of two faces, where a ray enters at both or leaves at both.
enum class Faces : std::uint8_t {
  one,    // nothing: it is convex and smooth
  round,  // one sheet of it may stand before another
  caps,   // across the z axis, they have one normal each; the rest is round
  flat,   // each has one normal
};

struct Sphere {  // unit radius about the origin
  static constexpr std::string_view name = "sphere";
  static constexpr Faces faces = Faces::one;
  static std::array<NamedNumber, 0> numbers() { return {}; }
  bool operator==(const Sphere&) const = default;
};

struct Cube {  // [0,1]^3
  static constexpr std::string_view name = "cube";
  static constexpr Faces faces = Faces::flat;
  static std::array<NamedNumber, 0> numbers() { return {}; }
  bool operator==(const Cube&) const = default;
};

struct Plane {  // the half-space z < 0; its face is z = 0
  static constexpr std::string_view name = "plane";
  static constexpr Faces faces = Faces::flat;
  static std::array<NamedNumber, 0> numbers() { return {}; }
  bool operator==(const Plane&) const = default;
};

struct Cylinder {  // x^2 + y^2 < 1, z_min < z < z_max; infinite limits mean no cap
  double z_min = -std::numeric_limits<double>::infinity();
  double z_max = std::numeric_limits<double>::infinity();

  static constexpr std::string_view name = "cylinder";
  static constexpr Faces faces = Faces::caps;
  std::array<NamedNumber, 2> numbers() const { return {{{"z_min", z_min}, {"z_max", z_max}}}; }
  bool operator==(const Cylinder&) const = default;
};

/// x^2 + y^2 < z^2, z_min < z < z_max; its apex is the origin. Limits of different signs keep both nappes,
/// infinite ones mean no cap.
struct Cone {
  double z_min = 0, z_max = 1;

  static constexpr std::string_view name = "cone";
  static constexpr Faces faces = Faces::caps;
  std::array<NamedNumber, 2> numbers() const { return {{{"z_min", z_min}, {"z_max", z_max}}}; }
  bool operator==(const Cone&) const = default;
};

/// Axis z; the tube's centre runs on the circle of radius R in z = 0, the tube has radius r. Both > 0. A
/// spindle torus (R < r) is the apple without the lemon.
struct Torus {
  double R = 1, r = 0.25;

  static constexpr std::string_view name = "torus";
  static constexpr Faces faces = Faces::round;
  std::array<NamedNumber, 2> numbers() const { return {{{"R", R}, {"r", r}}}; }
  bool operator==(const Torus&) const = default;
};

/// [0,1]^3 with edges and corners rounded by r, 0 < r <= 0.5, which makes it a ball.
struct RoundedCube {
  double r = 0.1;

  static constexpr std::string_view name = "rounded_cube";
  static constexpr Faces faces = Faces::one;
  std::array<NamedNumber, 1> numbers() const { return {{{"r", r}}}; }
  bool operator==(const RoundedCube&) const = default;
};

/// A surface of triangles or of Bezier patches, by its number in Scene::assets. It is a solid when it is closed, else
/// a sheet.
struct Mesh {
  std::uint32_t asset = 0;
  bool smooth = true;  // shaded with the normals of its corners

  static constexpr std::string_view name = "mesh";
  static constexpr Faces faces = Faces::round;
  static std::array<NamedNumber, 0> numbers() { return {}; }
  bool operator==(const Mesh&) const = default;
};

struct Bezier {
  std::uint32_t asset = 0;

  static constexpr std::string_view name = "bezier";
  static constexpr Faces faces = Faces::round;
  static std::array<NamedNumber, 0> numbers() { return {}; }
  bool operator==(const Bezier&) const = default;
};

using Solid = std::variant<Sphere, Cube, Plane, Cylinder, Torus, Cone, Mesh, Bezier, RoundedCube>;

/// The number of the asset that a solid is made of; none for those made of a few numbers.
inline const std::uint32_t* asset_of(const Solid& solid) {
  if (const auto* mesh = std::get_if<Mesh>(&solid)) return &mesh->asset;
  if (const auto* bezier = std::get_if<Bezier>(&solid)) return &bezier->asset;
  return nullptr;
}

/// The word for a solid: in scripts, messages and the browser.
inline std::string_view kind_of(const Solid& solid) {
  return std::visit([](const auto& s) { return s.name; }, solid);
}

enum class CsgOp : std::uint8_t { unite, intersect, subtract, exclusive_or };

}  // namespace rayfarm
