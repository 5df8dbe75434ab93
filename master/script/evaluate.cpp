#include <csignal>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>

#include "master/script/exchange.h"
#include "master/script/script.h"
#include "master/script/script_files.h"
#include "master/script/spawn.h"

namespace rayfarm {
namespace {

constexpr std::size_t max_text = 16 << 20;   // bytes of a script
constexpr std::size_t max_reply = 1u << 30;  // bytes of an encoded scene
constexpr std::size_t max_printed = 64 << 10;

/// In the build folder and when installed, programs are in bin and this is beside it.
std::filesystem::path helper_program() {
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  return self.parent_path().parent_path() / "lib/rayfarm/rayfarm-script";
}

/// Forwards what a script prints to the standard error stream, each line after the script's name.
class Printer {
 public:
  explicit Printer(std::string name) : name_(std::move(name)) {}

  void take(std::string_view bytes) {
    for (const char c : bytes) {
      if (printed_ > max_printed) return;
      if (++printed_ > max_printed) {
        std::fprintf(stderr, "%s%s: prints too much, the rest is dropped\n", at_start_ ? "" : "\n",
                     name_.c_str());
        return;
      }
      if (at_start_) std::fprintf(stderr, "%s: ", name_.c_str());
      at_start_ = c == '\n';
      // A script must not steer the terminal.
      const bool is_control = static_cast<unsigned char>(c) < 32 && c != '\n' && c != '\t';
      std::fputc(is_control || c == 127 ? '?' : c, stderr);
    }
  }

 private:
  std::string name_;
  std::size_t printed_ = 0;
  bool at_start_ = true;
};

/// Why a helper that sent no reply ended.
std::string reason(const HelperEnd& end, const ScriptLimits& limits) {
  if (end.kind == HelperEnd::Kind::timed_out)
    return "the script takes more than " + std::to_string(limits.wall.count() / 1000.0).substr(0, 4) +
           " s, is there an endless loop?";
  if (end.kind == HelperEnd::Kind::output_too_long) return "the scene is too large";
  if (end.kind == HelperEnd::Kind::stopped) return "interrupted";
  if (end.kind == HelperEnd::Kind::signalled && end.code == SIGXCPU)
    return "the script takes more than " + std::to_string(limits.cpu_seconds) +
           " s of processor time: an endless loop, or a string pattern with many repetitions?";
  if (end.kind == HelperEnd::Kind::signalled)
    return "the evaluation was ended by signal " + std::to_string(end.code) +
           "; too little memory on this computer?";
  return "the evaluation failed with exit code " + std::to_string(end.code);
}

/// One evaluation in a child of its own.
ScriptReply reply_to(const ScriptTask& asked, const std::function<bool()>& stop) {
  const auto& [request, files, limits] = asked;
  Printer printer(request.name);
  const std::string task = encode_task(asked);
  HelperEnd end;
  try {
    end = run_helper(
        {helper_program(), task, limits.wall, max_reply, [&](std::string_view s) { printer.take(s); }, stop});
  } catch (const std::system_error& error) {
    throw SceneError(request.name + ": cannot start the script helper: " + error.what() +
                     "; is rayfarm installed whole?");
  }
  if (end.kind != HelperEnd::Kind::exited || end.code != 0)
    throw SceneError(request.name + ": " + reason(end, limits));
  try {
    return decode_reply(end.output);
  } catch (const SceneError&) {
    throw;
  } catch (const std::exception& error) {
    throw SceneError(request.name + ": the script helper's answer is damaged: " + error.what());
  }
}

}  // namespace

ScriptResult evaluate(const ScriptRequest& request, const ScriptLimits& limits,
                      const std::function<bool()>& stop) {
  if (request.text.size() > max_text)
    throw SceneError(request.name + ": a script may have at most " + std::to_string(max_text >> 20) + " MB");
  // First none, then those that it names; an animation may name others at the time of its frame.
  constexpr int most_rounds = 3;
  ScriptTask task{request, {}, limits};
  for (int round = 0; round < most_rounds; ++round) {
    ScriptReply reply = reply_to(task, stop);
    if (auto* result = std::get_if<ScriptResult>(&reply)) return std::move(*result);
    add_files(task.files, request, std::get<std::vector<std::string>>(reply));
  }
  throw SceneError(request.name + ": names other files each time it is evaluated");
}

ScriptRequest read_script(const std::filesystem::path& file, std::map<std::string, std::string> params) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file))
    throw SceneError("cannot read the scene script " + file.string());
  std::string text(max_text + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  ScriptRequest request{file.filename().string(), std::move(text), std::move(params)};
  request.folder = file.has_parent_path() ? file.parent_path() : ".";
  return request;
}

ScriptResult evaluate_file(const std::filesystem::path& file, std::map<std::string, std::string> params,
                           std::uint32_t frame) {
  ScriptRequest request = read_script(file, std::move(params));
  request.frame = frame;
  return evaluate(request);
}

}  // namespace rayfarm
