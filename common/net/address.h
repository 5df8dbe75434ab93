// Where a peer is, as people write it.
#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace rayfarm {

struct Address {
  std::string host;
  std::uint16_t port = 0;
  bool operator==(const Address&) const = default;
};

/// An address that cannot be used; the message names it and the fix.
struct AddressError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// An address that other PCs can reach, or that is one of theirs, without permission.
struct ExposureError : AddressError {
  using AddressError::AddressError;
};

/// HOST, HOST:PORT, [IPV6] or [IPV6]:PORT.
Address parse_address(std::string_view text, std::uint16_t default_port);
std::string text_of(const Address& address);

}  // namespace rayfarm
