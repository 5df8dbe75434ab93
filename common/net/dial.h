// From an address to a connection, protected as it must be: what can be reached from other PCs is encrypted, unless
// the user said that everybody on the network may read and change what the farm does.
#pragma once
#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <chrono>
#include <optional>

#include "common/net/address.h"
#include "common/net/channel.h"
#include "common/net/exposure.h"

namespace rayfarm {

struct Security {
  Exposure exposure = Exposure::loopback_only;
  std::optional<TlsContext> tls{};  // none: it has no certificate, and speaks plaintext or not at all
};

/// Listens there; port 0 takes any free one. Throws AddressError, or ExposureError when other PCs could reach
/// it and nothing would be encrypted.
asio::ip::tcp::acceptor listen_at(asio::io_context& io, const Address& address, const Security& security);

/// The next one who connects. Waits while this process has no file descriptor left.
asio::awaitable<asio::ip::tcp::socket> accept(asio::ip::tcp::acceptor& acceptor);

/// What becomes of it: encrypted, when the other side begins so; else plaintext. Throws ConnectionLost when plaintext is
/// not allowed between the two, the handshake fails or takes longer than `patience`, or the certificate that is shown is
/// not to be believed. One that shows none is for the caller to judge.
asio::awaitable<Channel> greet(asio::ip::tcp::socket socket, Security security,
                               std::chrono::milliseconds patience);

/// Connects within `patience`: plaintext where it is allowed, else encrypted. Throws AddressError when there is no such
/// host, ExposureError when it takes a certificate to talk to it and there is none, ConnectionLost when nobody answers
/// or it is not who it should be.
asio::awaitable<Channel> dial(Address address, Security security, std::chrono::milliseconds patience);

/// Connects, always encrypted, and leaves it to the caller to judge who answers.
asio::awaitable<Channel> dial_encrypted(Address address, TlsContext context,
                                        std::chrono::milliseconds patience);

}  // namespace rayfarm
