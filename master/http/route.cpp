#include "master/http/route.h"

#include <charconv>
#include <nlohmann/json.hpp>

#include "master/http/submission.h"

namespace rayfarm {

ApiResponse shown(const nlohmann::json& value) {
  return {200, "application/json", value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

JobId job_id(const Call& call, std::size_t argument) {
  const std::string& text = call.arguments.at(argument);
  std::uint64_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc{} || end != text.data() + text.size())
    throw ApiError(400, "a job's id is a whole number, is " + text);
  return JobId{id};
}

std::uint64_t number_in(const std::map<std::string, std::string>& query, const std::string& name) {
  const auto found = query.find(name);
  std::uint64_t number = 0;
  if (found == query.end()) return number;
  std::from_chars(found->second.data(), found->second.data() + found->second.size(), number);
  return number;
}

nlohmann::json body_of(const Call& call) {
  if (call.request.body.empty()) return nlohmann::json::object();
  return parse_json(call.request.body);
}

}  // namespace rayfarm
