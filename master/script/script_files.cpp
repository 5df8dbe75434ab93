#include "master/script/script_files.h"

#include <algorithm>
#include <fstream>

namespace rayfarm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_names = 1000;
constexpr std::uint64_t max_bytes = 512u << 20;  // of all files of a script

/// The file that the name stands for. Throws SceneError without the script's name.
fs::path found(const fs::path& folder, const std::string& name) {
  if (folder.empty())
    throw SceneError("cannot read \"" + name +
                     "\": a script that is sent alone has no files; use rayfarm submit");
  const auto outside = [&] {
    return SceneError("cannot read \"" + name +
                      "\": a script may only name files of its own folder and those below");
  };
  const fs::path relative(name);
  if (relative.is_absolute() || std::ranges::find(relative, fs::path("..")) != relative.end())
    throw outside();
  std::error_code error;
  const fs::path top = fs::canonical(folder, error), file = fs::canonical(folder / relative, error);
  if (error || !fs::is_regular_file(file, error))
    throw SceneError("cannot read \"" + name + "\": there is no such file in the script's folder");
  const auto [end_of_top, ignored] = std::ranges::mismatch(top, file);
  if (end_of_top != top.end()) throw outside();
  return file;
}

std::string contents(const fs::path& file, const std::string& name, std::uint64_t most) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw SceneError("cannot read \"" + name + "\": it is not open to you");
  std::string bytes;
  char buffer[1 << 16];
  while (in.read(buffer, sizeof buffer) || in.gcount() > 0) {
    bytes.append(buffer, static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > most)
      throw SceneError("cannot read \"" + name + "\": the files of a script may have at most " +
                       std::to_string(max_bytes >> 20) + " MB together");
  }
  return bytes;
}

}  // namespace

void add_files(ScriptFiles& files, const ScriptRequest& request, const std::vector<std::string>& names) {
  if (files.size() + names.size() > max_names)
    throw SceneError(request.name + ": names more than " + std::to_string(max_names) + " files");
  std::uint64_t bytes = 0;
  for (const auto& [name, content] : files) bytes += content.size();
  for (const std::string& name : names) try {
      const std::string& content = files[name] =
          contents(found(request.folder, name), name, max_bytes - bytes);
      bytes += content.size();
    } catch (const SceneError& error) {
      throw SceneError(request.name + ": " + error.what());
    }
}

}  // namespace rayfarm
