// Point clouds on disk: PLY, as its authors (G. Turk, 1994) and the programs that read it have it.
//
// The z of points and normals is mirrored: a scene is left-handed (x right, y up, z away from the viewer), the
// programs that show clouds are right-handed.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rayfarm {

/// As in the file: z mirrored.
struct PlyPoint {
  std::array<float, 3> position{}, normal{};
  std::array<std::uint8_t, 3> color{};
};

enum class PlyForm : std::uint8_t {
  binary,   // little endian: x y z nx ny nz float32, red green blue bytes; 27 bytes a point
  ascii,    // the same as text, a line a point
  compact,  // little endian: x y z float32, the normal as two octahedral numbers of 16 bits, colour; 19 bytes
};
std::optional<PlyForm> ply_form_named(std::string_view name);

/// What stands before the points. Equally long for all numbers of points, so that it can be written again when
/// their number is known.
std::string ply_header(PlyForm form, std::uint64_t points);
void append_ply(PlyForm form, std::span<const PlyPoint> points, std::vector<std::uint8_t>& bytes);

/// A unit vector's place on an octahedron folded open to a square; off by less than 0.004 degrees when it comes
/// back. Source: Q. Meyer et al., On Floating-Point Normal Vectors, CGF 29(4), 2010.
using Octahedral = std::array<std::uint16_t, 2>;
Octahedral octahedral(const std::array<float, 3>& unit);
std::array<float, 3> unit_of(const Octahedral& place);

}  // namespace rayfarm
