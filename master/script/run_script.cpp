#include "master/script/run_script.h"

#include <lauxlib.h>

#include "master/script/animation.h"
#include "master/script/lua_assets.h"
#include "master/script/lua_library.h"
#include "master/script/lua_nodes.h"
#include "master/script/lua_params.h"
#include "master/script/lua_scene.h"
#include "master/script/lua_state.h"
#include "master/script/script_run.h"

namespace rayfarm {
namespace {

struct Job {
  const ScriptRequest& request;
  const ScriptFiles& files;
  double time;  // seconds
};

/// Makes all that a script may use known, then compiles it. Leaves the script on the stack.
int prepare(lua_State* L) {
  const Job& job = *static_cast<const Job*>(lua_touserdata(L, 1));
  open_library(L);
  open_nodes(L);
  open_node_methods(L);
  open_scene(L);
  open_assets(L);
  open_params(L);
  lua_pushnumber(L, job.time);
  lua_setglobal(L, "time");
  make_globals_strict(L);

  std::string_view text = job.request.text;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  const std::string chunk = "@" + job.request.name;
  if (luaL_loadbufferx(L, text.data(), text.size(), chunk.c_str(), "t") != LUA_OK) lua_error(L);
  return 1;
}

ScriptReply run_at(const Job& job, const ScriptLimits& limits) {
  ScriptRun run{job.request.params, job.files};
  LuaState state(limits.memory_bytes, std::chrono::seconds(limits.cpu_seconds));
  lua_State* const L = state.get();
  set_run(L, run);
  lua_pushcfunction(L, prepare);
  lua_pushlightuserdata(L, const_cast<Job*>(&job));
  state.call(1, 1);
  state.call(0, 1);
  check_all_declared(run);
  if (!luaL_testudata(L, -1, LuaName<SceneMark>::value))
    throw SceneError("the script must end with return scene{ ... }, it returns " + description(L, -1));
  if (!run.missing_files.empty()) return std::vector(run.missing_files.begin(), run.missing_files.end());
  return ScriptResult{std::move(*run.scene), run.assets.take_data(), std::move(run.parameters)};
}

ScriptReply run_frame(const ScriptTask& task, const Animation& animation) {
  const std::uint32_t frame = task.request.frame;
  check_frame(animation, frame);
  ScriptReply reply = run_at({task.request, task.files, time_of(animation, frame)}, task.limits);
  const auto* result = std::get_if<ScriptResult>(&reply);
  if (result && result->scene.animation != animation)
    throw SceneError("the animation of frame " + std::to_string(frame) +
                     " is another one; start, stop and fps must not change with time");
  return reply;
}

}  // namespace

ScriptReply run_script(const ScriptTask& task) {
  const ScriptRequest& request = task.request;
  try {
    if (request.animation) return run_frame(task, *request.animation);
    ScriptReply reply = run_at({request, task.files, 0}, task.limits);
    const auto* result = std::get_if<ScriptResult>(&reply);
    if (!result) return reply;
    if (!result->scene.animation) {
      expect_still(request.frame);
      return reply;
    }
    // What the time is only the script can say; where it is not 0, it is evaluated again.
    if (request.frame != 0 || result->scene.animation->start != 0)
      return run_frame(task, *result->scene.animation);
    return reply;
  } catch (const SceneError& error) {
    const std::string message = error.what();
    // Lua's messages begin with the file and line already.
    throw message.starts_with(request.name + ":") ? error : SceneError(request.name + ": " + message);
  } catch (const std::bad_alloc&) {
    throw SceneError(request.name + ": not enough memory");
  }
}

}  // namespace rayfarm
