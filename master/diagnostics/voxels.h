// Which cells of space have something in them.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace rayfarm {

/// Cubes of one size, a corner of one at the origin. Memory grows with the cubes that are occupied (16 to 32
/// bytes each), not with the points that come; a cube is known by a hash of 64 bits.
class OccupiedVoxels {
 public:
  static constexpr std::size_t most = 50'000'000;  // cubes: under a gigabyte

  /// side > 0.
  explicit OccupiedVoxels(double side) : side_(side), slots_(1024) {}

  /// Whether the point's cube was empty; now it is not. Throws FileError when there are too many.
  bool take(const std::array<float, 3>& point);

 private:
  std::size_t slot_of(std::uint64_t cube) const;
  void grow();

  double side_;
  std::vector<std::uint64_t> slots_;  // a power of two of them, at most half in use; 0: empty
  std::size_t count_ = 0;
};

}  // namespace rayfarm
