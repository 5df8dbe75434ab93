// From an address to a socket. Without encryption, a farm that is not told otherwise stays on its own PC.
#pragma once
#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <chrono>

#include "common/net/address.h"

namespace rayfarm {

enum class Exposure : bool { loopback_only, insecure };

/// Listens there; port 0 takes any free one. Throws AddressError, or ExposureError when other PCs could reach
/// it.
asio::ip::tcp::acceptor listen_at(asio::io_context& io, const Address& address, Exposure exposure);

/// The next one who connects. Waits while this process has no file descriptor left.
asio::awaitable<asio::ip::tcp::socket> accept(asio::ip::tcp::acceptor& acceptor);

/// Connects within `patience`. Throws AddressError when there is no such host, ExposureError when it is
/// another PC and plaintext was not allowed, ConnectionLost when nobody answers.
asio::awaitable<asio::ip::tcp::socket> dial(Address address, Exposure exposure,
                                            std::chrono::milliseconds patience);

}  // namespace rayfarm
