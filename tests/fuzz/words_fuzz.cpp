// Short texts that people or strangers give: addresses, request targets, codes, base 64; the first byte says which.
//
// Law: what was read is written to what is read as the same.
#include <stdexcept>

#include "common/net/address.h"
#include "common/net/secrets.h"
#include "master/http/request_target.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {
namespace {

void read_address(std::string_view text) try {
  const Address address = parse_address(text, 5411);
  require(parse_address(text_of(address), 1) == address, "an address that was written is the same");
} catch (const AddressError&) {}

void read_target(std::string_view text) try {
  const RequestTarget target = parse_target(text);
  std::string written = "/";
  for (const std::string& segment : target.path) written += percent_encoded(segment) + "/";
  require(parse_target(written).path == target.path, "a path that was written is the same");
} catch (const std::invalid_argument&) {}

void read_token(std::string_view text) try {
  const Token token = parse_token(text);
  require(parse_token(text_of(token)) == token, "a token that was written is the same");
} catch (const CodecError&) {}

void read_base64(std::string_view text) try {
  const Bytes bytes = from_base64(text);
  require(from_base64(base64(bytes)) == bytes, "base 64 loses nothing");
} catch (const CodecError&) {}

}  // namespace

void fuzz(ByteView bytes) {
  constexpr void (*readers[])(std::string_view) = {read_address, read_target, read_token, read_base64};
  const std::uint8_t which = take_byte(bytes) % std::size(readers);
  readers[which](text_of(bytes));
}

}  // namespace rayfarm
