#include "common/net/address.h"

#include <charconv>

namespace rayfarm {
namespace {

[[noreturn]] void fail(std::string_view text, const std::string& what) {
  throw AddressError("address \"" + std::string(text) + "\": " + what +
                     "; write HOST, HOST:PORT or [IPV6]:PORT");
}

std::uint16_t parse_port(std::string_view text, std::string_view port) {
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (error != std::errc{} || end != port.data() + port.size())
    fail(text, "the port must be a number from 0 to 65535, is \"" + std::string(port) + "\"");
  return number;
}

}  // namespace

Address parse_address(std::string_view text, std::uint16_t default_port) {
  const bool bracketed = text.starts_with('[');
  const std::size_t closing = text.find(']');
  if (bracketed && closing == std::string_view::npos) fail(text, "a ] is missing");
  const std::string_view host = bracketed ? text.substr(1, closing - 1) : text.substr(0, text.find(':'));
  const std::string_view rest = text.substr(bracketed ? closing + 1 : host.size());
  if (host.empty()) fail(text, "the host is missing");
  if (!bracketed && host.find_first_of(" \t/@[]") != std::string_view::npos) fail(text, "that is no host");
  if (!bracketed && rest.size() > 1 && rest.find(':', 1) != std::string_view::npos)
    fail(text, "an IPv6 address needs brackets");
  if (rest.empty()) return {std::string(host), default_port};
  if (!rest.starts_with(':')) fail(text, "only a port may follow the bracket");
  return {std::string(host), parse_port(text, rest.substr(1))};
}

std::string text_of(const Address& address) {
  const bool v6 = address.host.find(':') != std::string::npos;
  return (v6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

}  // namespace rayfarm
