// How far a daemon trusts what is around it.
#pragma once
#include <cstdint>

namespace rayfarm {

/// Where plaintext is spoken, and where nobody is asked who they are: nowhere, between programs of one PC, everywhere.
enum class Exposure : std::uint8_t { closed, loopback_only, insecure };

}  // namespace rayfarm
