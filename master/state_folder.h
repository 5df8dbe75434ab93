// The folder that belongs to one running master: nothing is written anywhere else.
#pragma once
#include <filesystem>

namespace rayfarm {

/// Locked while it lives, however the process ends.
class StateFolder {
 public:
  /// Makes the folder if it is missing. Throws std::runtime_error when it cannot be written, or is another
  /// master's.
  explicit StateFolder(const std::filesystem::path& folder);
  ~StateFolder();
  StateFolder(const StateFolder&) = delete;

 private:
  int lock_ = -1;
};

}  // namespace rayfarm
