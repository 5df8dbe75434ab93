#include "worker/join.h"

#include <asio/io_context.hpp>

#include "common/net/connection.h"
#include "common/net/dial.h"
#include "common/net/run_until_end.h"
#include "common/net/until_first_ends.h"

namespace rayfarm {
namespace {

Join request_of(const Token& code, const std::string& key, const std::string& name) {
  const std::string request = certificate_request(key);
  return {.versions = {},
          .software = RAYFARM_VERSION,
          .secret = code.secret,
          .name = name,
          .request = Bytes(request.begin(), request.end())};
}

std::string certificate_in(const ToWorker& answer) {
  if (const auto* refused = std::get_if<Refused>(&answer)) throw VersionRefused(refused->reason);
  const auto* paired = std::get_if<Paired>(&answer);
  if (!paired) throw JoinRefused("who answers does not do what a master does");
  return {paired->certificate.begin(), paired->certificate.end()};
}

asio::awaitable<void> receive_answer(MasterConnection& connection, std::optional<ToWorker>& answer) {
  connection.expect_message_within(handshake_patience);
  answer = co_await connection.receive();
}

/// A stranger is not told why it is refused.
[[noreturn]] void refused() {
  throw JoinRefused(
      "the master does not take this code: it is wrong, used up, expired or revoked (its log says which); "
      "ask for a "
      "new one: rayfarm token new --role worker");
}

asio::awaitable<void> converse(Token code, Address master, std::string name, Pairing& pairing) {
  auto dialling = dial_encrypted(master, TlsContext::of_stranger(), handshake_patience);
  Channel channel = co_await std::move(dialling);
  try {
    pairing.authority = channel.authority_behind(code.farm);
  } catch (const CertificateError& error) {
    throw JoinRefused(std::string(error.what()) + "; nothing was told to it");
  }
  pairing.own.key = new_key();
  pairing.master = master;
  MasterConnection connection(std::move(channel), {});
  connection.post(request_of(code, pairing.own.key, name));
  std::optional<ToWorker> answer;
  try {
    auto loops = until_first_ends(connection.tend(), receive_answer(connection, answer));
    co_await std::move(loops);
  } catch (const ConnectionLost&) {
    refused();
  }
  pairing.own.certificate = certificate_in(*answer);
  if (!is_of_key(pairing.own.certificate, pairing.own.key) ||
      !is_signed_by(pairing.own.certificate, pairing.authority))
    throw JoinRefused("the certificate that the master gave is not ours");
}

}  // namespace

Invitation parse_invitation(std::string_view text) {
  const std::size_t at = text.find('@');
  try {
    Invitation invitation{parse_token(text.substr(0, at))};
    if (at != text.npos) invitation.master = parse_address(text.substr(at + 1), default_farm_port);
    return invitation;
  } catch (const CodecError& error) {
    throw std::invalid_argument(std::string("this is no pairing code: ") + error.what());
  }
}

Pairing join(const Token& code, const Address& master, const std::string& name) {
  asio::io_context io;
  Pairing pairing;
  run_until_end(io, converse(code, master, name, pairing));
  return pairing;
}

}  // namespace rayfarm
