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

std::optional<std::uint32_t> whole_in(const Call& call, const std::string& name) {
  const auto text = text_in(call, name);
  if (!text) return std::nullopt;
  const auto number = number_of<std::uint32_t>(*text);
  if (!number) throw ApiError(400, name + " must be a whole number, is " + *text);
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
