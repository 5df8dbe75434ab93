#include "master/diagnostics/voxels.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <string>

#include "common/math/hash.h"
#include "master/files/image_file.h"

namespace rayfarm {
namespace {

/// Never 0.
std::uint64_t hash_of_cube(const std::array<float, 3>& point, double side) {
  std::uint64_t hash = 0;
  for (const float v : point)
    hash = keyed(hash, std::bit_cast<std::uint64_t>(std::floor(v / side) + 0.0));  // -0 as +0
  return hash == 0 ? 1 : hash;
}

}  // namespace

std::size_t OccupiedVoxels::slot_of(std::uint64_t cube) const {
  std::size_t slot = cube & (slots_.size() - 1);
  while (slots_[slot] != 0 && slots_[slot] != cube) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

bool OccupiedVoxels::take(const std::array<float, 3>& point) {
  const std::uint64_t cube = hash_of_cube(point, side_);
  const std::size_t slot = slot_of(cube);
  if (slots_[slot] == cube) return false;
  if (count_ == most) {
    char side[32];
    throw FileError("over 50 million voxels of size " +
                    std::string(side, std::to_chars(side, side + sizeof side, side_).ptr) +
                    " have points in them; choose a larger size");
  }
  slots_[slot] = cube;
  if (2 * ++count_ > slots_.size()) grow();
  return true;
}

void OccupiedVoxels::grow() {
  std::vector<std::uint64_t> old(2 * slots_.size());
  old.swap(slots_);
  for (const std::uint64_t cube : old)
    if (cube != 0) slots_[slot_of(cube)] = cube;
}

}  // namespace rayfarm
