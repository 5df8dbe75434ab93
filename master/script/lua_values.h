// Reading what a script passes: tables with known keys, numbers in range, vectors, colours.
// Whatever does not fit throws SceneError; guarded() turns that into a Lua error with the script's file and
// line.
//
// Lua's headers are included as C++ (no extern "C"): the library is its C++ build, whose errors unwind.
#pragma once
#include <lua.h>

#include <lauxlib.h>

#include <glm/glm.hpp>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/scene/scene.h"

namespace rayfarm {

using LuaFunction = int (*)(lua_State*);

/// Pushes the message behind the file and line of the Lua code that called the running C function.
void push_error(lua_State* L, std::string_view message);

/// f as Lua sees it: SceneError and exhausted memory become Lua errors. (Lua's own errors are C++ exceptions
/// of another type in the C++ build of Lua; they pass, and destructors run.)
template <LuaFunction f>
int guarded(lua_State* L) {
  try {
    return f(L);
  } catch (const SceneError& error) {
    push_error(L, error.what());
  } catch (const std::bad_alloc&) {
    push_error(L, "not enough memory");
  }
  return lua_error(L);
}

/// What a table-taking function such as torus{ ... } understands.
struct Signature {
  std::string_view function;
  std::vector<std::string_view> keys;
  std::size_t by_position = 0;  // the first so many keys may also be given without their names
};

/// A number as Lua prints it.
std::string text_of(double x);
/// "a node", "nil", "the number 3": for messages.
std::string description(lua_State* L, int index);

constexpr std::uint32_t max_exponent = 1'000'000;

enum class Range { finite, infinite_too, positive, not_negative };
/// The number at the index. `what` names it in messages: "torus: r".
double number_at(lua_State* L, int index, const std::string& what, Range range = Range::finite);
/// {x, y, z}
glm::dvec3 vector_at(lua_State* L, int index, const std::string& what, Range range = Range::finite);
/// {r, g, b}, or one number for a grey; not negative.
glm::dvec3 color_at(lua_State* L, int index, const std::string& what);

/// The table that a function is called with. Keys that the signature does not know are refused at once.
class Fields {
 public:
  Fields(lua_State* L, int index, const Signature& signature);

  /// Pushes the value and answers true, or pushes nothing and answers false when it is absent.
  bool push(std::string_view key) const;
  double number(std::string_view key, double otherwise, Range range = Range::finite) const;
  std::uint32_t integer(std::string_view key, std::uint32_t otherwise, std::uint32_t least,
                        std::uint32_t most) const;
  glm::dvec3 vector(std::string_view key, const glm::dvec3& otherwise, Range range = Range::finite) const;
  glm::dvec3 color(std::string_view key, const glm::dvec3& otherwise) const;
  bool boolean(std::string_view key, bool otherwise) const;
  std::optional<std::string> text(std::string_view key) const;
  bool has(std::string_view key) const;
  /// Throws unless the key is there.
  void require(std::string_view key) const;
  std::string place(std::string_view key) const;  // "torus: r"
  std::string function() const { return std::string(signature_.function); }

 private:
  void check_keys() const;

  lua_State* L_;
  int index_;
  const Signature& signature_;
};

// Values of our own, as userdata without finalizers. --------------------------------------------------------

template <class T>
struct LuaName;
template <>
struct LuaName<Material> {
  static constexpr const char* value = "material";
};
template <>
struct LuaName<Texture> {
  static constexpr const char* value = "texture";
};
template <>
struct LuaName<Camera> {
  static constexpr const char* value = "camera";
};
template <>
struct LuaName<Light> {
  static constexpr const char* value = "light";
};

/// Pushes a new userdata that holds the value, with `companions` Lua values that live as long.
template <class T>
T& push_value(lua_State* L, const T& value, int companions = 0) {
  static_assert(std::is_trivially_destructible_v<T>, "there is no finalizer to destroy it");
  T* const made = new (lua_newuserdatauv(L, sizeof(T), companions)) T(value);
  luaL_setmetatable(L, LuaName<T>::value);
  return *made;
}

/// The value at the index. `what` names it in messages: "scene: camera".
template <class T>
const T& value_at(lua_State* L, int index, const std::string& what) {
  if (const void* value = luaL_testudata(L, index, LuaName<T>::value)) return *static_cast<const T*>(value);
  throw SceneError(what + " must be a " + LuaName<T>::value + ", is " + description(L, index));
}

}  // namespace rayfarm
