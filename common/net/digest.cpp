#include <openssl/evp.h>

#include <array>
#include <climits>

#include "common/net/codec.h"

namespace rayfarm {

std::string sha256_hex(ByteView bytes) {
  std::array<std::uint8_t, EVP_MAX_MD_SIZE> digest;
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available in this OpenSSL");
  std::string hex;
  for (unsigned i = 0; i < size; ++i) {
    hex += "0123456789abcdef"[digest[i] >> 4];
    hex += "0123456789abcdef"[digest[i] & 15];
  }
  return hex;
}

std::string base64(ByteView bytes) {
  if (bytes.size() > INT_MAX / 2) throw CodecError("more than 1 GB cannot be written as base64");
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // OpenSSL ends it with a zero
  const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(),
                                   static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(size));
  return text;
}

Bytes from_base64(std::string_view text) {
  if (text.size() > INT_MAX) throw CodecError("base64 text is longer than 2 GB");
  Bytes bytes(text.size() / 4 * 3);
  const int size = text.size() % 4 != 0
                       ? -1
                       : EVP_DecodeBlock(bytes.data(), reinterpret_cast<const unsigned char*>(text.data()),
                                         static_cast<int>(text.size()));
  if (size >= 0) {
    const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with("=") ? 1 : 0;
    bytes.resize(static_cast<std::size_t>(size) - padding);
  }
  // OpenSSL forgives spaces and stray bits: only the one text that base64() writes is taken.
  if (size < 0 || base64(bytes) != text) throw CodecError("not base64");
  return bytes;
}

}  // namespace rayfarm
