// The API's description, built into the program.
#pragma once
#include <string_view>

namespace rayfarm {

extern const std::string_view openapi_json;

}  // namespace rayfarm
