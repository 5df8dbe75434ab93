#include "common/net/secrets.h"

#include <openssl/crypto.h>
#include <openssl/rand.h>

#include <array>
#include <stdexcept>

namespace rayfarm {
namespace {

// Source: D. Crockford, Base 32, 2019.
constexpr std::string_view digits = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";

constexpr std::size_t half = 12;  // bytes of the farm's fingerprint, and of the secret
constexpr std::size_t group = 5;

int value_of(char c) {
  const char capital = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  if (capital == 'I' || capital == 'L') return 1;
  if (capital == 'O') return 0;
  const std::size_t place = digits.find(capital);
  if (place == std::string_view::npos) throw CodecError("there is a letter or sign in it that no code has");
  return static_cast<int>(place);
}

std::string hex(ByteView bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

void append_hex(Bytes& bytes, const std::string& text) {
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
}

std::uint8_t checksum_of(ByteView bytes) {
  return static_cast<std::uint8_t>(std::stoi(sha256_hex(bytes).substr(0, 2), nullptr, 16));
}

}  // namespace

Bytes random_bytes(std::size_t count) {
  Bytes bytes(count);
  if (RAND_bytes(bytes.data(), static_cast<int>(count)) != 1)
    throw std::runtime_error("OpenSSL has no random numbers");
  return bytes;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string base32(ByteView bytes) {
  std::string text;
  std::uint32_t waiting = 0;
  int bits = 0;
  for (const std::uint8_t byte : bytes) {
    waiting = waiting << 8 | byte;
    for (bits += 8; bits >= 5; bits -= 5) text += digits[waiting >> (bits - 5) & 31];
  }
  return text;
}

Bytes from_base32(std::string_view text) {
  Bytes bytes;
  std::uint32_t waiting = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '-' || c == ' ') continue;
    waiting = waiting << 5 | static_cast<std::uint32_t>(value_of(c));
    bits += 5;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(waiting >> bits));
  }
  if (bits != 0) throw CodecError("it has too few or too many letters");
  return bytes;
}

Token new_token(const std::string& authority_fingerprint) {
  return {authority_fingerprint.substr(0, 2 * half), hex(random_bytes(half))};
}

std::string text_of(const Token& token) {
  Bytes bytes;
  append_hex(bytes, token.farm);
  append_hex(bytes, token.secret);
  bytes.push_back(checksum_of(bytes));
  std::string text = base32(bytes);
  for (std::size_t at = text.size() - group; at > 0; at -= group) text.insert(at, 1, '-');
  return text;
}

Token parse_token(std::string_view text) {
  const Bytes bytes = from_base32(text);
  if (bytes.size() != 2 * half + 1) throw CodecError("it has too few or too many letters");
  const ByteView content = ByteView(bytes).first(2 * half);
  if (checksum_of(content) != bytes.back()) throw CodecError("a letter of it is wrong");
  return {hex(content.first(half)), hex(content.subspan(half))};
}

std::string hash_of_secret(const std::string& secret) {
  return sha256_hex({reinterpret_cast<const std::uint8_t*>(secret.data()), secret.size()});
}

}  // namespace rayfarm
