// Disks of our own that fail as real ones do.
#pragma once
#include <cstddef>
#include <filesystem>

namespace rayfarm {

/// One that is soon full: from now on this process and its children see a disk of so many bytes in this folder. errno when
/// this machine allows none.
int enter_small_disk(const std::filesystem::path& folder, std::size_t bytes);

/// One that loses its power or becomes read-only: an ext4 in a file of its own, by a loop device.
class LoopDisk {
 public:
  /// Both are made.
  LoopDisk(std::filesystem::path file, std::filesystem::path folder);

  /// From now on this process and its children see it in the folder. errno when this machine allows none: it wants root.
  int enter() const;

  // What follows throws std::runtime_error when it cannot be done.
  /// What is not on it yet will never be; whoever reads or writes has a fault.
  void cut_power() const;
  /// As a disk's first fault does with most file systems.
  void turn_read_only() const;
  /// As it is after a new start of the PC. Nobody has a file there open.
  void mount_again() const;

 private:
  void mount() const;

  const std::filesystem::path file_, folder_;
};

}  // namespace rayfarm
