// A Lua state with a cap on its memory and on its processor time.
#pragma once
#include <lua.h>

#include <chrono>
#include <cstdint>
#include <memory>

namespace rayfarm {

class LuaState {
 public:
  /// Throws std::bad_alloc when not even an empty state fits.
  LuaState(std::uint64_t memory_bytes, std::chrono::seconds cpu);
  ~LuaState();
  LuaState(const LuaState&) = delete;
  LuaState& operator=(const LuaState&) = delete;

  lua_State* get() const { return state_; }
  /// Calls what is on the stack (a function and its arguments, as lua_call wants them). Throws SceneError
  /// with Lua's message, or that of the limit that ended the call.
  void call(int arguments, int results);

 private:
  struct Budget {
    std::uint64_t memory_bytes = 0, used_bytes = 0;
    std::chrono::nanoseconds cpu_end{};  // of the thread's processor time
    std::chrono::seconds cpu{};          // for the message
  };
  static void* allocate(void* budget, void* old, std::size_t old_size, std::size_t new_size);
  static void check_time(lua_State* L, lua_Debug* where);

  Budget budget_;
  lua_State* state_ = nullptr;
};

}  // namespace rayfarm
