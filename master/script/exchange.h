// What rayfarm-script is asked and answers, as bytes: one line of JSON, then the script's text or the scene's bytes.
#pragma once
#include <string>
#include <string_view>

#include "master/script/script.h"

namespace rayfarm {

struct ScriptTask {
  ScriptRequest request;
  ScriptLimits limits;
};

std::string encode_task(const ScriptTask& task);
/// For the child, which may trust its parent.
ScriptTask decode_task(std::string_view bytes);

std::string encode_reply(const ScriptResult& result);
std::string encode_error(std::string_view message);
/// The result, checked anew: the child is not trusted. An error of the script throws SceneError; bytes that
/// no sound child sends throw std::runtime_error.
ScriptResult decode_reply(std::string_view bytes);

}  // namespace rayfarm
