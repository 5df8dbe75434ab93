#include "common/net/dial.h"

#include <algorithm>
#include <asio/connect.hpp>
#include <asio/redirect_error.hpp>
#include <asio/steady_timer.hpp>

#include "common/net/connection.h"
#include "common/net/text.h"
#include "common/net/until_first_ends.h"

namespace rayfarm {
namespace {

using asio::ip::tcp;
using Places = tcp::resolver::results_type;

constexpr std::uint8_t tls_handshake = 22;  // the first byte of a client that wants TLS: RFC 8446, 5.1

/// Also as a listener on [::] sees it: ::ffff:127.0.0.1.
bool is_loopback(const asio::ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address.is_loopback();
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).is_loopback();
}

bool allows_plaintext(Exposure exposure, const asio::ip::address& address) {
  return exposure == Exposure::insecure || (exposure == Exposure::loopback_only && is_loopback(address));
}

bool allow_plaintext(Exposure exposure, const Places& places) {
  return std::ranges::all_of(
      places, [&](const auto& place) { return allows_plaintext(exposure, place.endpoint().address()); });
}

void check_exposure(const Places& places, const Address& address, const Security& security) {
  if (security.tls || allow_plaintext(security.exposure, places)) return;
  throw ExposureError(
      "address \"" + text_of(address) +
      (security.exposure == Exposure::closed
           ? "\" would be used without encryption, and --closed forbids that even here"
           : "\" is not on this PC alone, and there is no certificate to encrypt with") +
      ": give a master --state FOLDER, pair a worker with rayfarm-worker join; or say --insecure if "
      "everybody on the network may read and change what the farm does");
}

[[noreturn]] void no_such_host(const Address& address, const asio::error_code& error) {
  throw AddressError("address \"" + text_of(address) + "\" cannot be used: " + error.message());
}

/// What a refused certificate says of itself is anybody's words, for a log.
void check_peer(const Channel& channel) {
  if (!channel.peer() || channel.peer()->fault.empty()) return;
  const std::string& name = channel.peer()->facts.name;
  const bool is_name = name.size() <= max_owner_name && is_plain_text(name);
  throw ConnectionLost("the certificate of " + (is_name ? '"' + name + '"' : std::string("no name")) +
                       " is refused: " + channel.peer()->fault);
}

asio::awaitable<Places> resolve(const Address& address) {
  tcp::resolver resolver(co_await asio::this_coro::executor);
  const std::string port = std::to_string(address.port);
  asio::error_code error;
  Places places =
      co_await resolver.async_resolve(address.host, port, asio::redirect_error(asio::use_awaitable, error));
  if (error) no_such_host(address, error);
  co_return places;
}

asio::awaitable<tcp::socket> connect(const Places& places, const Address& address) {
  tcp::socket socket(co_await asio::this_coro::executor);
  asio::error_code error;
  co_await asio::async_connect(socket, places, asio::redirect_error(asio::use_awaitable, error));
  if (error) throw ConnectionLost("nobody answers at " + text_of(address) + ": " + error.message());
  co_return socket;
}

asio::awaitable<void> connect_securely(std::optional<Channel>& channel, Address address, Security security) {
  const Places places = co_await resolve(address);
  check_exposure(places, address, security);
  tcp::socket socket = co_await connect(places, address);
  if (allow_plaintext(security.exposure, places)) {
    channel.emplace(std::move(socket));
    co_return;
  }
  auto handshake = encrypt_dialled(std::move(socket), *security.tls);
  channel = co_await std::move(handshake);
  check_peer(*channel);
}

asio::awaitable<void> connect_encrypted(std::optional<Channel>& channel, Address address,
                                        TlsContext context) {
  const Places places = co_await resolve(address);
  tcp::socket socket = co_await connect(places, address);
  auto handshake = encrypt_dialled(std::move(socket), context);
  channel = co_await std::move(handshake);
}

asio::awaitable<void> take(std::optional<Channel>& channel, tcp::socket socket, Security security) {
  std::uint8_t first = 0;
  co_await socket.async_receive(asio::buffer(&first, 1), tcp::socket::message_peek, asio::use_awaitable);
  if (first == tls_handshake) {
    auto handshake = encrypt_accepted(std::move(socket), *security.tls);
    channel = co_await std::move(handshake);
    check_peer(*channel);
  } else if (allows_plaintext(security.exposure, socket.remote_endpoint().address())) {
    channel.emplace(std::move(socket));
  } else {
    throw ConnectionLost("it does not encrypt what it says");
  }
}

asio::awaitable<void> give_up_after(std::chrono::milliseconds patience, std::string reason) {
  asio::steady_timer timer(co_await asio::this_coro::executor, patience);
  co_await timer.async_wait(asio::use_awaitable);
  throw ConnectionLost(reason);
}

}  // namespace

tcp::acceptor listen_at(asio::io_context& io, const Address& address, const Security& security) {
  tcp::resolver resolver(io);
  asio::error_code error;
  const auto found = resolver.resolve(address.host, std::to_string(address.port), error);
  if (error) no_such_host(address, error);
  check_exposure(found, address, security);
  try {
    return tcp::acceptor(io, found.begin()->endpoint());
  } catch (const asio::system_error& failed) {
    throw AddressError("cannot listen at \"" + text_of(address) + "\": " + failed.code().message());
  }
}

asio::awaitable<tcp::socket> accept(tcp::acceptor& acceptor) {
  asio::steady_timer pause(acceptor.get_executor());
  for (;;) {
    tcp::socket socket(acceptor.get_executor());
    asio::error_code error;
    co_await acceptor.async_accept(socket, asio::redirect_error(asio::use_awaitable, error));
    if (!error) co_return socket;
    if (error == asio::error::operation_aborted) throw asio::system_error(error);
    pause.expires_after(std::chrono::milliseconds(100));
    co_await pause.async_wait(asio::use_awaitable);
  }
}

asio::awaitable<Channel> greet(tcp::socket socket, Security security,
                               std::chrono::milliseconds patience) try {
  if (!security.tls) co_return Channel(std::move(socket));  // where it listens, nothing else is needed
  std::optional<Channel> channel;
  auto greeting = until_first_ends(take(channel, std::move(socket), std::move(security)),
                                   give_up_after(patience, "it said nothing in time"));
  co_await std::move(greeting);
  co_return std::move(*channel);
} catch (const asio::system_error& error) {
  lose(error);
}

asio::awaitable<Channel> dial(Address address, Security security, std::chrono::milliseconds patience) try {
  std::optional<Channel> channel;
  auto attempt = until_first_ends(connect_securely(channel, address, std::move(security)),
                                  give_up_after(patience, "nobody answers at " + text_of(address)));
  co_await std::move(attempt);
  co_return std::move(*channel);
} catch (const asio::system_error& error) {
  lose(error);
}

asio::awaitable<Channel> dial_encrypted(Address address, TlsContext context,
                                        std::chrono::milliseconds patience) try {
  std::optional<Channel> channel;
  auto attempt = until_first_ends(connect_encrypted(channel, address, context),
                                  give_up_after(patience, "nobody answers at " + text_of(address)));
  co_await std::move(attempt);
  co_return std::move(*channel);
} catch (const asio::system_error& error) {
  lose(error);
}

}  // namespace rayfarm
