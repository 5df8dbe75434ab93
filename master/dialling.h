// A worker that the master shall reach, as people see it.
#pragma once
#include <stdexcept>
#include <string>

namespace rayfarm {

struct Dialling {
  std::string name, address;
  std::string message;  // why it was not reached; empty before the first try has ended
};

/// The name cannot be dialled; the message says what to do.
struct NameInUse : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace rayfarm
