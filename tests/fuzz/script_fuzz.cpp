// Scene scripts, as the limited child evaluates them. What its process is limited for from without (a library call that
// never returns) is no fault here: libFuzzer's -timeout tells of it.
//
// Law: what a script yields is a scene that travels.
#include "master/script/run_script.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {

void fuzz(ByteView bytes) {
  constexpr ScriptLimits limits{.wall = {}, .cpu_seconds = 1, .memory_bytes = 64u << 20};
  const ScriptTask task{{"fuzz.lua", std::string(text_of(bytes)), {}}, {}, limits};
  ScriptReply reply;
  try {
    reply = run_script(task);
  } catch (const SceneError&) {
    return;
  }
  const auto* result = std::get_if<ScriptResult>(&reply);
  if (!result) return;
  const std::string answer = encode_reply(*result);
  require(encode_reply(std::get<ScriptResult>(decode_reply(answer))) == answer,
          "what a script yields is a scene that travels");
}

}  // namespace rayfarm
