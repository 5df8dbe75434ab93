#include "master/http/scene_library.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "master/http/api_error.h"

namespace rayfarm {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> scripts_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code absent;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, absent))
    if (entry.path().extension() == ".lua") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

OfferedScene offered(const fs::path& file) {
  OfferedScene scene{file.stem().string(), file.filename().string(), "", {}, ""};
  const std::string text = content_of(file);
  scene.title = first_sentence(text);
  try {
    ScriptResult result = evaluate({scene.script, text, {}, 0, {}, file.parent_path()});
    scene.facts = {std::move(result.parameters), result.scene.image, result.scene.animation};
  } catch (const SceneError& error) {
    scene.error = error.what();
  }
  return scene;
}

}  // namespace

std::string first_sentence(const std::string& script) {
  std::istringstream lines(script);
  std::string comment;
  for (std::string line; std::getline(lines, line) && line.starts_with("--");) {
    const std::size_t words = line.find_first_not_of("- ");
    if (words == std::string::npos) break;
    comment += (comment.empty() ? "" : " ") + line.substr(words);
    if (const std::size_t end = comment.find(". "); end != std::string::npos)
      return comment.substr(0, end + 1);
    if (comment.ends_with('.')) break;
  }
  return comment;
}

std::vector<OfferedScene> SceneLibrary::scenes() const {
  std::vector<OfferedScene> all;
  const std::lock_guard lock(mutex_);
  for (const fs::path& file : scripts_in(folder_)) {
    std::error_code gone;
    const fs::file_time_type written = fs::last_write_time(file, gone);
    const auto known = known_.find(file.string());
    if (known == known_.end() || known->second.written != written)
      known_[file.string()] = {written, offered(file)};
    all.push_back(known_[file.string()].scene);
  }
  return all;
}

std::string SceneLibrary::script(const std::string& name) const {
  for (const fs::path& file : scripts_in(folder_))
    if (file.stem() == name) return content_of(file);
  throw ApiError(404, "there is no scene " + name + "; GET /api/v1/scenes lists those that there are");
}

}  // namespace rayfarm
