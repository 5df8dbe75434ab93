// What a request gets instead of what it asked for.
#pragma once
#include <stdexcept>
#include <string>

#include "master/farm.h"

namespace rayfarm {

struct ApiError : std::runtime_error {
  ApiError(unsigned status, const std::string& message) : std::runtime_error(message), status(status) {}
  unsigned status;  // of HTTP
};

inline std::string text_of(JobId id) { return "job " + std::to_string(static_cast<std::uint64_t>(id)); }
/// Of a farm that does not have it.
inline ApiError no_such_job(const Farm& farm, JobId id) {
  if (farm.was_here(id)) return {410, text_of(id) + " is no longer kept; submit it again"};
  return {404, "there is no " + text_of(id)};
}

}  // namespace rayfarm
