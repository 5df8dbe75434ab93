// A fuzz target is one function; libFuzzer calls it with bytes that it makes from the corpus, and keeps those that crash
// it, break a law, or take too much time or memory.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "common/net/codec.h"

namespace rayfarm {

/// Each target defines it. What its door throws for bad input it catches; anything else ends the program.
void fuzz(ByteView bytes);

/// `law` says what has to hold.
inline void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", law);
  std::abort();
}

inline std::string_view text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Takes the first byte off: a choice of the target's. 0 when there is none.
inline std::uint8_t take_byte(ByteView& bytes) {
  if (bytes.empty()) return 0;
  const std::uint8_t first = bytes.front();
  bytes = bytes.subspan(1);
  return first;
}

}  // namespace rayfarm
