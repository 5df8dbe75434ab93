// --json: one value a line on stdout, at once.
#pragma once
#include <cstdio>
#include <nlohmann/json.hpp>

namespace rayfarm {

inline void print_json(const nlohmann::json& value) {
  std::printf("%s\n", value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  std::fflush(stdout);
}

}  // namespace rayfarm
