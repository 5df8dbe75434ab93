#include "common/net/dial.h"

#include <asio/connect.hpp>
#include <asio/redirect_error.hpp>
#include <asio/steady_timer.hpp>

#include "common/net/connection.h"
#include "common/net/until_first_ends.h"

namespace rayfarm {
namespace {

using asio::ip::tcp;

void check_exposure(const tcp::resolver::results_type& found, const Address& address, Exposure exposure) {
  if (exposure == Exposure::insecure) return;
  for (const auto& entry : found)
    if (!entry.endpoint().address().is_loopback())
      throw ExposureError(
          "address \"" + text_of(address) +
          "\" is not on this PC alone, and the farm is not encrypted yet: use 127.0.0.1, or say "
          "--insecure if everybody on the network may read and change what the farm does");
}

[[noreturn]] void no_such_host(const Address& address, const asio::error_code& error) {
  throw AddressError("address \"" + text_of(address) + "\" cannot be used: " + error.message());
}

asio::awaitable<void> connect(tcp::socket& socket, Address address, Exposure exposure) {
  tcp::resolver resolver(socket.get_executor());
  const std::string port = std::to_string(address.port);
  asio::error_code error;
  const tcp::resolver::results_type found =
      co_await resolver.async_resolve(address.host, port, asio::redirect_error(asio::use_awaitable, error));
  if (error) no_such_host(address, error);
  check_exposure(found, address, exposure);
  co_await asio::async_connect(socket, found, asio::redirect_error(asio::use_awaitable, error));
  if (error) throw ConnectionLost("nobody answers at " + text_of(address) + ": " + error.message());
}

asio::awaitable<void> give_up_after(std::chrono::milliseconds patience, Address address) {
  asio::steady_timer timer(co_await asio::this_coro::executor, patience);
  co_await timer.async_wait(asio::use_awaitable);
  throw ConnectionLost("nobody answers at " + text_of(address));
}

}  // namespace

tcp::acceptor listen_at(asio::io_context& io, const Address& address, Exposure exposure) {
  tcp::resolver resolver(io);
  asio::error_code error;
  const auto found = resolver.resolve(address.host, std::to_string(address.port), error);
  if (error) no_such_host(address, error);
  check_exposure(found, address, exposure);
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

asio::awaitable<tcp::socket> dial(Address address, Exposure exposure, std::chrono::milliseconds patience) {
  tcp::socket socket(co_await asio::this_coro::executor);
  auto attempt = until_first_ends(connect(socket, address, exposure), give_up_after(patience, address));
  co_await std::move(attempt);
  co_return socket;
}

}  // namespace rayfarm
