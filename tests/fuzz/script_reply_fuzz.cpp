// What comes back from the child that evaluates scripts: it may have been taken over by one.
#include <exception>

#include "master/script/exchange.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {

void fuzz(ByteView bytes) {
  try {
    decode_reply(text_of(bytes));
  } catch (const std::exception&) {  // as its caller does
  }
}

}  // namespace rayfarm
