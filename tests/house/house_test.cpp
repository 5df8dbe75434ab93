// The house: who may include whom, and which library belongs to which room.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace rayfarm {
namespace {

namespace fs = std::filesystem;
const fs::path top = RAYFARM_SOURCE_DIR;

struct Include {
  std::string file, room;  // who includes
  std::string what;        // as written between quotes or angle brackets
  bool own;                // in quotes
};

/// "common/net/codec.cpp" lies in "common/net", "master/farm.cpp" in "master", "master/cli/x.cpp" in
/// "master/cli".
std::string room_of(const std::string& file) { return file.substr(0, file.rfind('/')); }

std::vector<Include> all_includes() {
  std::vector<Include> found;
  const std::regex line(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  for (const char* wing : {"common", "master", "worker"})
    for (const auto& entry : fs::recursive_directory_iterator(top / wing)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      const std::string file = fs::relative(entry.path(), top).string();
      std::ifstream in(entry.path());
      std::smatch match;
      for (std::string text; std::getline(in, text);)
        if (std::regex_search(text, match, line))
          found.push_back({file, room_of(file), match[2], match[1] == "\""});
    }
  return found;
}

TEST(House, IncludesGoInOneDirectionOnly) {
  // math <- geometry <- scene <- render <- net <- { work, master, worker }; never to the right.
  const std::vector<std::string> order{"common/math",   "common/geometry", "common/scene",
                                       "common/render", "common/net",      "common/work"};
  const auto rank = [&](const std::string& room) {
    return std::find(order.begin(), order.end(), room) - order.begin();
  };
  int checked = 0;
  for (const Include& i : all_includes()) {
    if (!i.own) continue;
    ++checked;
    const std::string target = room_of(i.what);
    const bool from_common = i.room.starts_with("common/");
    EXPECT_FALSE(from_common && !target.starts_with("common/")) << i.file << " includes " << i.what;
    EXPECT_FALSE(i.room.starts_with("worker") && target.starts_with("master"))
        << i.file << " includes " << i.what;
    EXPECT_FALSE(i.room.starts_with("master") && target.starts_with("worker"))
        << i.file << " includes " << i.what;
    const bool in_order = i.room == "common/daemon" ? target == i.room : rank(target) <= rank(i.room);
    EXPECT_TRUE(!from_common || in_order) << i.file << " includes " << i.what;
    EXPECT_TRUE(fs::exists(top / i.what)) << i.file << " includes " << i.what << ", which is not there";
  }
  EXPECT_GT(checked, 100);
}

TEST(House, LibrariesStayInTheirRooms) {
  const std::map<std::string, std::set<std::string>> rooms{
      {"boost/", {"master/http", "master/http/live"}},
      {"cereal/", {"common/net", "master/journal"}},
      {"SQLiteCpp/", {"master/journal"}},
      {"sqlite3.h", {"master/journal"}},
      {"OpenImageIO/", {"master/files"}},
      {"lua", {"master/script"}},
      {"nlohmann/",
       {"master/access", "master/http", "master/http/live", "master/cli", "master/diagnostics",
        "master/script"}},
      {"spdlog/", {"master", "worker"}},
      {"CLI/", {"common/daemon", "master/cli"}},
      {"toml++/", {"common/daemon"}},
      {"openssl/", {"common/net"}},
      {"tiny_obj_loader.h", {"master/script"}},
      {"zstd.h", {"common/net"}},
  };
  for (const Include& i : all_includes())
    for (const auto& [library, allowed] : rooms)
      EXPECT_TRUE(i.own || !i.what.starts_with(library) || allowed.contains(i.room))
          << i.file << " includes <" << i.what << ">";
}

TEST(House, TheTopLevelHoldsWhatItMust) {
  const std::set<std::string> allowed{"CMakeLists.txt", "master", "worker", "common",
                                      "scenes",         "tests",  "deploy", "README.md"};
  for (const auto& entry : fs::directory_iterator(top)) {
    const std::string name = entry.path().filename();
    if (name.starts_with(".") || name.starts_with("build")) continue;  // what git and builds put there
    EXPECT_TRUE(allowed.contains(name)) << name;
  }
}

TEST(House, TheRenderPathCallsNoFunctionWhoseBitsDependOnTheCpu) {
  const std::regex call(
      R"((std|glm)::(sin|cos|tan|asin|acos|atan2?|exp2?|log2?|log10|pow|hypot|cbrt|rotate|radians)\s*\()");
  int files = 0;
  for (const char* room : {"common/math", "common/geometry", "common/scene", "common/render"})
    for (const auto& entry : fs::directory_iterator(top / room)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      ++files;
      std::ifstream in(entry.path());
      for (std::string text; std::getline(in, text);)
        EXPECT_FALSE(std::regex_search(text, call)) << entry.path() << ": " << text;
    }
  EXPECT_GT(files, 30);
}

}  // namespace
}  // namespace rayfarm
