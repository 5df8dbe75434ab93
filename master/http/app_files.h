// The browser app: a folder of files beside the program, in memory from the start.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "master/http/message.h"

namespace rayfarm {

/// In ../share/rayfarm as seen from the program's folder, both where it was built and where it is installed.
std::filesystem::path shared_folder(const std::string& name);

class AppFiles {
 public:
  /// Reads the folder; without it the app is a page that says what to do.
  explicit AppFiles(const std::filesystem::path& folder = shared_folder("web"));

  /// "/" is index.html. 404 for what is not there: a path never leads out of the folder.
  ApiResponse answer(const std::string& path) const;

 private:
  std::map<std::string, ApiResponse, std::less<>> files_;  // by path: "/assets/app-3f2a.js"
};

}  // namespace rayfarm
