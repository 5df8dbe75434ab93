#include "master/http/app_files.h"

#include <array>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

namespace rayfarm {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<std::string_view, std::string_view>, 12> types{{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".ico", "image/x-icon"},
    {".txt", "text/plain; charset=utf-8"},
    {".woff2", "font/woff2"},
    {".wasm", "application/wasm"},
    {".webmanifest", "application/manifest+json"},
}};

std::string type_of(const fs::path& file) {
  for (const auto& [extension, type] : types)
    if (file.extension() == extension) return std::string(type);
  return "application/octet-stream";
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The names under /assets tell the content: another content has another name.
Caching caching_of(std::string_view path) {
  return path.starts_with("/assets/") ? Caching::for_ever : Caching::ask_again;
}

constexpr const char* no_app = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>rayfarm</title><link rel="icon" href="data:,"></head>
<body><h1>rayfarm</h1>
<p>This master was built without its browser app. Build it with <code>cmake --build BUILD --target rayfarm-web</code>
(its tools come with <code>deploy/setup.sh</code>), then start the master again.</p>
<p>The command <code>rayfarm</code> and the <a href="/api/v1/openapi.json">HTTP API</a> work without it.</p>
</body></html>
)";

}  // namespace

fs::path shared_folder(const std::string& name) {
  return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share" / "rayfarm" / name;
}

AppFiles::AppFiles(const fs::path& folder) {
  files_["/"] = {200, type_of("index.html"), no_app, Caching::ask_again};
  std::error_code absent;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, absent)) {
    if (!entry.is_regular_file()) continue;
    const std::string path = "/" + fs::relative(entry.path(), folder).generic_string();
    files_[path] = {200, type_of(entry.path()), content_of(entry.path()), caching_of(path)};
  }
  if (const auto index = files_.find("/index.html"); index != files_.end()) files_["/"] = index->second;
}

ApiResponse AppFiles::answer(const std::string& path) const {
  const auto file = files_.find(path);
  return file != files_.end() ? file->second : error_response(404, "there is nothing at " + path);
}

}  // namespace rayfarm
