// A file appears whole or not at all.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace rayfarm {

/// A file that comes together beside its target: until commit() an old file is as it was, and without it
/// nothing is left behind. Follows a symbolic link to its target. All of it throws FileError (image_file.h).
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& file);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void append(std::span<const std::uint8_t> bytes);
  /// Writes over what was appended first.
  void put_at_start(std::span<const std::uint8_t> bytes);
  /// Syncs and renames; the last thing to be called.
  void commit();

 private:
  [[noreturn]] void fail() const;
  bool take_rights_of_target();

  std::filesystem::path file_, target_;  // as named, and where links lead
  std::string passing_name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

void write_atomically(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace rayfarm
