#include "master/script/lua_state.h"

#include <lauxlib.h>
#include <time.h>

#include <cstdlib>
#include <new>
#include <string>

#include "master/script/lua_values.h"

namespace rayfarm {
namespace {

constexpr int instructions_between_checks = 100'000;  // about a millisecond

std::chrono::nanoseconds thread_cpu_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

}  // namespace

LuaState::LuaState(std::uint64_t memory_bytes, std::chrono::seconds cpu)
    : budget_{memory_bytes, 0, thread_cpu_time() + cpu, cpu}, state_(lua_newstate(allocate, &budget_)) {
  if (!state_) throw std::bad_alloc();
  lua_sethook(state_, check_time, LUA_MASKCOUNT, instructions_between_checks);
  lua_gc(state_, LUA_GCINC, 1000, 400,
         0);  // scripts keep nearly all they make: collect when it has grown tenfold
}

LuaState::~LuaState() { lua_close(state_); }

void* LuaState::allocate(void* budget, void* old, std::size_t old_size, std::size_t new_size) {
  Budget& b = *static_cast<Budget*>(budget);
  if (!old) old_size = 0;  // then it tells the kind of object
  if (new_size == 0) {
    std::free(old);
    b.used_bytes -= old_size;
    return nullptr;
  }
  if (new_size > old_size && new_size - old_size > b.memory_bytes - b.used_bytes) return nullptr;
  void* const block = std::realloc(old, new_size);
  if (block) b.used_bytes += new_size - old_size;
  return block;
}

void LuaState::check_time(lua_State* L, lua_Debug* where) {
  void* budget = nullptr;
  lua_getallocf(L, &budget);
  const Budget& b = *static_cast<Budget*>(budget);
  if (thread_cpu_time() < b.cpu_end) return;
  // From now on at each instruction, so that no pcall can carry on, here or in the main thread.
  lua_rawgeti(L, LUA_REGISTRYINDEX, LUA_RIDX_MAINTHREAD);
  for (lua_State* thread : {L, lua_tothread(L, -1)}) lua_sethook(thread, check_time, LUA_MASKCOUNT, 1);
  lua_getinfo(L, "Sl", where);
  lua_pushfstring(L, "%s:%d: the script takes more than %d s of processor time, is this an endless loop?",
                  where->short_src, where->currentline, static_cast<int>(b.cpu.count()));
  lua_error(L);
}

void LuaState::call(int arguments, int results) {
  const int status = lua_pcall(state_, arguments, results, 0);
  if (status == LUA_OK) return;
  if (status == LUA_ERRMEM)
    throw SceneError("not enough memory: the script's values take more than " +
                     std::to_string(budget_.memory_bytes >> 20) + " MB");
  if (lua_type(state_, -1) != LUA_TSTRING) throw SceneError("the error is " + description(state_, -1));
  const std::string message = lua_tostring(state_, -1);
  const bool too_deep = message.ends_with("C stack overflow");
  throw SceneError(too_deep ? message + ": expressions, tables or calls are nested too deep" : message);
}

}  // namespace rayfarm
