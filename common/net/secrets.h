// Secrets that people carry: made at random, kept as hashes, compared without telling where they differ.
#pragma once
#include <string>
#include <string_view>

#include "common/net/codec.h"

namespace rayfarm {

Bytes random_bytes(std::size_t count);
/// In a time that depends on the lengths alone.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// Crockford's base 32: no letter that looks like another one. A size that is a multiple of 5.
std::string base32(ByteView bytes);
/// Small letters, I and L for 1, O for 0, hyphens and spaces are understood. Throws CodecError on anything else.
Bytes from_base32(std::string_view text);

/// A pairing code, a token or a login code: a secret, and the farm that it is for.
struct Token {
  std::string farm;    // the first 24 hexadecimal digits (96 bits) of the fingerprint of its authority
  std::string secret;  // 24 hexadecimal digits (96 bits)
  bool operator==(const Token&) const = default;
};

Token new_token(const std::string& authority_fingerprint);
/// Eight groups of five letters and digits, the last two of which are a checksum against misreading.
std::string text_of(const Token& token);
/// Throws CodecError, whose message does not hold the text: it may be a secret but for one letter.
Token parse_token(std::string_view text);
/// What is kept of a secret.
std::string hash_of_secret(const std::string& secret);

}  // namespace rayfarm
