// How a PC becomes a worker of a farm, once.
#pragma once
#include <string>

#include "common/net/secrets.h"
#include "worker/pairing.h"

namespace rayfarm {

/// What an admin handed over: CODE@HOST[:PORT], or CODE when the address is known otherwise.
struct Invitation {
  Token code;
  std::optional<Address> master{};
};
/// Throws std::invalid_argument, whose message does not hold the code.
Invitation parse_invitation(std::string_view text);

/// The master did not take the code, or is another one than that which made it.
struct JoinRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The master is of a version that does not go with ours; the message says what to do.
struct VersionRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Says who it is only when it knows that the master's authority is the one that the code names. `name`: as the farm
/// shall list it. Throws JoinRefused, VersionRefused, AddressError, ConnectionLost.
Pairing join(const Token& code, const Address& master, const std::string& name);

}  // namespace rayfarm
