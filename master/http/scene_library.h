// The scenes that the master offers: a folder of scripts beside the program.
#pragma once
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "master/http/app_files.h"
#include "master/script/script.h"

namespace rayfarm {

/// What is known of a script before it is rendered.
struct ScriptFacts {
  std::vector<ScriptParameter> parameters;
  ImageDefaults image;
  std::optional<Animation> animation;
};

struct OfferedScene {
  std::string name;    // "sphere_flake"
  std::string script;  // "sphere_flake.lua"
  std::string title;   // the first sentence of the script's first comment
  ScriptFacts facts;
  std::string error;  // why it cannot be rendered; empty when it can
};

/// All calls are made from any thread; a script is evaluated when its file is new.
class SceneLibrary {
 public:
  explicit SceneLibrary(std::filesystem::path folder = shared_folder("scenes"))
      : folder_(std::move(folder)) {}

  std::vector<OfferedScene> scenes() const;  // by name
  /// Where the scripts lie, and the files that they name.
  const std::filesystem::path& folder() const { return folder_; }
  /// The script's text. Throws ApiError when there is no such scene.
  std::string script(const std::string& name) const;

 private:
  struct Known {
    std::filesystem::file_time_type written;
    OfferedScene scene;
  };

  const std::filesystem::path folder_;
  mutable std::mutex mutex_;  // guards known_
  mutable std::map<std::string, Known> known_;
};

/// Without the dashes.
std::string first_sentence(const std::string& script);

}  // namespace rayfarm
