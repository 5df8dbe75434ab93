#include "master/http/message.h"

#include <nlohmann/json.hpp>

namespace rayfarm {

ApiResponse error_response(unsigned status, const std::string& message) {
  const nlohmann::json body{{"error", message}};
  return {status, "application/json", body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

}  // namespace rayfarm
