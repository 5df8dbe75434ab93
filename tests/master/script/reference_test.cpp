// The reference page against the implementation: all that is there is described, all that is described is
// there.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "common/scene/scene.h"
#include "master/script/lua_assets.h"
#include "master/script/lua_library.h"
#include "master/script/lua_nodes.h"
#include "master/script/lua_params.h"
#include "master/script/lua_scene.h"
#include "tests/master/script/script_support.h"

namespace rayfarm {
namespace {

std::string page() {
  std::ifstream in(std::string(RAYFARM_SOURCE_DIR) + "/master/script/REFERENCE.md");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The page's examples, and the page without them.
struct Split {
  std::vector<std::string> examples;
  std::string prose;
};
Split split_page() {
  Split split;
  std::string rest = page();
  for (std::size_t begin; (begin = rest.find("```lua\n")) != std::string::npos;) {
    split.prose += rest.substr(0, begin);
    const std::size_t end = rest.find("\n```", begin + 7);
    split.examples.push_back(rest.substr(begin + 7, end - begin - 7));
    rest = rest.substr(end + 4);
  }
  split.prose += rest;
  return split;
}

/// The part of the prose under a heading.
std::string chapter(const std::string& title) {
  const std::string prose = split_page().prose;
  const std::size_t begin = prose.find("## " + title);
  EXPECT_NE(begin, std::string::npos) << title;
  return prose.substr(begin, prose.find("\n## ", begin) - begin);
}

/// All that a pattern's first group finds.
std::set<std::string> found(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> all;
  for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i) all.insert((*i)[1]);
  return all;
}

std::vector<Signature> all_signatures() {
  std::vector<Signature> all = node_signatures();
  for (const Signature& signature : scene_signatures()) all.push_back(signature);
  for (const Signature& signature : asset_signatures()) all.push_back(signature);
  all.push_back(param_signature());
  return all;
}

TEST(Reference, EveryExampleIsAScene) {
  const std::vector<std::string> examples = split_page().examples;
  EXPECT_GE(examples.size(), 5u);
  for (const std::string& example : examples) EXPECT_EQ(complaint(example), "") << example;
}

TEST(Reference, TheAnimationMovesCameraNodesMaterialsAndLights) {
  const auto examples = split_page().examples;
  const auto is_animation = [](const std::string& example) {
    return example.find("animation =") != std::string::npos;
  };
  const auto example = std::ranges::find_if(examples, is_animation);
  ASSERT_NE(example, examples.end());
  const Scene first = run(*example).scene, later = run(*example, {}, 100).scene;
  EXPECT_NE(first.camera, later.camera);
  EXPECT_NE(first.nodes, later.nodes);
  EXPECT_NE(first.materials, later.materials);
  EXPECT_NE(first.lights, later.lights);
}

TEST(Reference, EveryFunctionIsDescribedAndEveryDescribedOneIsThere) {
  std::set<std::string> known;
  for (const Signature& signature : all_signatures()) known.insert(std::string(signature.function));
  known.erase("image"), known.erase("animation");  // keys of scene{}
  const std::set<std::string> described = found(split_page().prose, "`([a-z_]+)[{(]");
  EXPECT_EQ(described, known);
  for (const std::string& name : known) EXPECT_EQ(text("type(" + name + ")"), "function") << name;
}

TEST(Reference, EveryKeyIsDescribed) {
  const std::string prose = split_page().prose;
  for (const Signature& signature : all_signatures())
    for (const std::string_view key : signature.keys) {
      const bool in_code = prose.find("`" + std::string(key) + "`") != std::string::npos;
      const bool in_table = prose.find(" " + std::string(key) + " = ...") != std::string::npos;
      EXPECT_TRUE(in_code || in_table) << signature.function << " " << key;
    }
}

TEST(Reference, EveryDescribedKeyIsThere) {
  std::set<std::string> known{"time"};
  for (const Signature& signature : all_signatures())
    known.insert(signature.keys.begin(), signature.keys.end());
  for (const char* title : {"Solids", "Surfaces", "Camera and lights", "The scene", "Parameters"})
    for (const std::string& key : found(chapter(title), "`([A-Za-z]+)`"))
      EXPECT_TRUE(known.contains(key)) << key;
}

TEST(Reference, EveryMethodIsDescribedAndEveryDescribedOneIsThere) {
  const std::vector<std::string>& names = method_names();
  EXPECT_EQ(found(chapter("Methods of nodes"), "`:([a-z_]+)"),
            std::set<std::string>(names.begin(), names.end()));
}

TEST(Reference, EveryStandardNameIsDescribedAsThereOrNotThere) {
  const std::string prose = chapter("What of Lua is there");
  const std::string there = prose.substr(0, prose.find("- The same script")),
                    missing = prose.substr(prose.find("Not there are"));
  const std::set<std::string> described = found(there, "`([a-z0-9]+)`");
  // Passed out by the message of an error, since names are short.
  const std::string listed = complaint("local s = '' for k in pairs(_G) do s = s .. ' ' .. k end error(s)");
  std::set<std::string> globals = found(listed.substr(listed.find(": ") + 1), " ([A-Za-z0-9_]+)");
  for (const Signature& signature : all_signatures()) globals.erase(std::string(signature.function));
  globals.erase("_G"), globals.erase("_VERSION"), globals.erase("time");
  EXPECT_EQ(described, globals);

  std::set<std::string> removed(removed_names().begin(), removed_names().end());
  removed.insert("__gc");
  EXPECT_EQ(found(missing, "`([a-z_.]+)`"), removed);
}

TEST(Reference, TheDefaultsAreThoseOfTheScene) {
  const std::string prose = split_page().prose;
  const Material m;
  const auto expect_told = [&](const std::string& told) {
    EXPECT_NE(prose.find(told), std::string::npos) << told;
  };
  const auto shown = [](double x) {
    return std::regex_replace(std::to_string(x), std::regex("\\.?0+$"), "");
  };
  expect_told("`ambient` (" + shown(m.ambient) + ")");
  expect_told("`diffuse` (" + shown(m.diffuse) + ")");
  expect_told("`specular` (" + shown(m.specular) + ")");
  expect_told("(" + std::to_string(m.exponent) + ", a whole");
  expect_told("(" + shown(m.index) + "), `schlick` (" + shown(m.schlick) + ";");
  expect_told("`angle` (" + shown(PerspectiveCamera{}.angle_deg) + ";");
  expect_told("`angle` (" + shown(FisheyeCamera{}.angle_deg) + ";");
  expect_told("`radius` (" + shown(ParabolicCamera{}.radius) + ":");
  expect_told("`size` of the mirror (" + shown(ParabolicCamera{}.size) + ";");
  expect_told("`width` (" + shown(OrthographicCamera{}.width) + ")");
  expect_told("`exponent` (" + std::to_string(Glow{}.exponent) + ", a whole");
  expect_told("`R` (" + shown(Torus{}.R) + "), `r` (" + shown(Torus{}.r) + ")");
  expect_told("`fps` (" + shown(Animation{}.fps) + ")");
  const ScriptLimits limits;
  expect_told(std::to_string(limits.cpu_seconds) + " s of processor time, " +
              std::to_string(limits.wall.count() / 1000) + " s in all");
  expect_told("and " + std::to_string(limits.memory_bytes >> 30) + " GB of memory");
}

}  // namespace
}  // namespace rayfarm
