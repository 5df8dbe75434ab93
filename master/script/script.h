// The script door: Lua text in, a Scene out, or an error that names file, line and fix.
//
// The text is evaluated once, in a limited child process (rayfarm-script): CPU time, memory and wall clock
// bounded, no files, no network. Nothing in the text can harm the caller.
#pragma once
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/net/messages.h"
#include "common/scene/scene.h"

namespace rayfarm {

struct ScriptLimits {
  std::chrono::milliseconds wall{20'000};
  std::uint32_t cpu_seconds = 15;
  std::uint64_t memory_bytes = 2ull << 30;  // of Lua's values
};

/// A parameter that the script declares with param{ ... }.
struct ScriptParameter {
  std::string name, type, default_value, help;  // type: int, number, string, boolean, choice
  std::vector<std::string> choices;
  std::optional<double> min, max;
  bool operator==(const ScriptParameter&) const = default;
};

struct ScriptRequest {
  std::string name;  // for messages: the file's name
  std::string text;
  std::map<std::string, std::string> params;  // -p key=value
  std::uint32_t frame = 0;                    // time = animation.start + frame / fps, at most animation.stop
  // As another frame of the script has it; then the script is evaluated once, and need not be asked first.
  std::optional<Animation> animation{};
  std::filesystem::path folder{};  // whose files it may name, and those below; empty: none
};

struct ScriptResult {
  Scene scene;                    // has passed check()
  std::vector<AssetData> assets;  // those of the scene, as they travel
  std::vector<ScriptParameter> parameters;
};

/// Throws SceneError: syntax or run-time error with file and line, an unknown key or parameter, a frame that the
/// animation has not, a limit exceeded; also soon after stop() said true, which is asked ten times a second.
ScriptResult evaluate(const ScriptRequest& request, const ScriptLimits& limits = {},
                      const std::function<bool()>& stop = {});

/// Throws SceneError when the file cannot be read.
ScriptRequest read_script(const std::filesystem::path& file, std::map<std::string, std::string> params);
/// Reads the file and evaluates it. Throws SceneError also when it cannot be read.
ScriptResult evaluate_file(const std::filesystem::path& file, std::map<std::string, std::string> params,
                           std::uint32_t frame);

}  // namespace rayfarm
