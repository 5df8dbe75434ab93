// A worker that the master shall reach, as people see it.
#pragma once
#include <string>

namespace rayfarm {

struct Dialling {
  std::string name, address;
  std::string message;  // why it was not reached; empty before the first try has ended
};

}  // namespace rayfarm
