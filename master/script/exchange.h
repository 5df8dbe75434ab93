// What rayfarm-script is asked and answers, as bytes: one line of JSON, then the script's text and the files it may
// read, or the scene's and its assets' bytes.
#pragma once
#include <string>
#include <string_view>
#include <variant>

#include "master/script/script.h"

namespace rayfarm {

/// Files by the names by which the script asks for them.
using ScriptFiles = std::map<std::string, std::string, std::less<>>;

struct ScriptTask {
  ScriptRequest request;
  ScriptFiles files;
  ScriptLimits limits;
};

std::string encode_task(const ScriptTask& task);
/// For the child, which may trust its parent.
ScriptTask decode_task(std::string_view bytes);

std::string encode_reply(const ScriptResult& result);
std::string encode_error(std::string_view message);
/// The script asks for files that it was not given.
std::string encode_wish(const std::vector<std::string>& files);

/// The result, or the files that are missing.
using ScriptReply = std::variant<ScriptResult, std::vector<std::string>>;
/// Checked anew: the child is not trusted. An error of the script throws SceneError; bytes that no sound child sends
/// throw std::runtime_error.
ScriptReply decode_reply(std::string_view bytes);

}  // namespace rayfarm
