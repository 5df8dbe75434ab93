#include "master/http/query.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace rayfarm {
namespace {

/// The whole text as a number.
template <class Number>
std::optional<Number> number_of(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

void expect_known(const std::map<std::string, std::string>& query,
                  const std::map<std::string, std::string>& known) {
  std::string names;
  for (const auto& [name, ignored] : known) names += (names.empty() ? "" : ", ") + name;
  for (const auto& [name, ignored] : query)
    if (!known.contains(name))
      throw ApiError(400, "\"" + name + "\" is unknown in the query; " +
                              (names.empty() ? "nothing may stand there" : "known are: " + names));
}

std::optional<std::string> text_in(const Call& call, const std::string& name) {
  const auto found = call.query.find(name);
  return found == call.query.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> real_in(const Call& call, const std::string& name) {
  const auto text = text_in(call, name);
  if (!text) return std::nullopt;
  const auto number = number_of<double>(*text);
  if (!number || !std::isfinite(*number)) throw ApiError(400, name + " must be a number, is " + *text);
  return number;
}

std::optional<std::uint32_t> whole_in(const Call& call, const std::string& name, WholeRange range) {
  const auto text = text_in(call, name);
  if (!text) return std::nullopt;
  const auto number = number_of<std::uint32_t>(*text);
  if (!number || *number < range.low || *number > range.high)
    throw ApiError(400, name + " must be a whole number from " + std::to_string(range.low) + " to " +
                            std::to_string(range.high) + ", is " + *text);
  return number;
}

bool switch_in(const Call& call, const std::string& name) {
  return choice_in(call, name, "0", "0 or 1", [](const std::string& text) {
    return text == "0" || text == "1" ? std::optional(text == "1") : std::nullopt;
  });
}

ApiResponse in_the_making(double progress) {
  ApiResponse response = shown({{"state", "making"}, {"progress", progress}});
  response.status = 202;
  return response;
}

}  // namespace rayfarm
