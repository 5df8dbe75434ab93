#include "master/http/request_target.h"

#include <charconv>
#include <cstdint>
#include <stdexcept>

namespace rayfarm {
namespace {

std::string decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    std::uint8_t byte = 0;
    const char* digits = text.data() + i + 1;
    if (i + 2 >= text.size() || std::from_chars(digits, digits + 2, byte, 16).ptr != digits + 2 || byte == 0)
      throw std::invalid_argument("the address holds a broken %-escape");
    result += static_cast<char>(byte);
    i += 2;
  }
  return result;
}

/// Calls visit(part) for each part between separators; an empty text has none.
template <class Visit>
void for_each_part(std::string_view text, char separator, Visit&& visit) {
  while (!text.empty()) {
    const std::size_t end = text.find(separator);
    visit(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  }
}

}  // namespace

RequestTarget parse_target(std::string_view text) {
  if (text.empty() || text.front() != '/') throw std::invalid_argument("the address must begin with /");
  RequestTarget target;
  const std::size_t question = text.find('?');
  for_each_part(text.substr(1, question == std::string_view::npos ? question : question - 1), '/',
                [&](std::string_view segment) { target.path.push_back(decoded(segment)); });
  if (question == std::string_view::npos) return target;
  for_each_part(text.substr(question + 1), '&', [&](std::string_view pair) {
    const std::size_t equals = pair.find('=');
    target.query[decoded(pair.substr(0, equals))] =
        equals == std::string_view::npos ? "" : decoded(pair.substr(equals + 1));
  });
  return target;
}

std::string percent_encoded(std::string_view text) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (plain.find(c) != std::string_view::npos)
      result += c;
    else
      (result += '%') += {digits[byte >> 4], digits[byte & 15]};
  }
  return result;
}

}  // namespace rayfarm
