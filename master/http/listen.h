// Where the HTTP server listens.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "master/http/guard.h"
#include "master/http/server.h"

namespace rayfarm {

/// Of the other end; as IPv4 where a listener on [::] sees it wrapped (::ffff:127.0.0.1). Throws when it has gone.
boost::asio::ip::address peer_address(const boost::asio::ip::tcp::socket& socket);
/// Throws HttpError.
boost::asio::ip::tcp::acceptor acceptor_at(boost::asio::io_context& io, const HttpSettings& settings);
ListenAddress address_of(const boost::asio::ip::tcp::acceptor& acceptor, const HttpSettings& settings);
std::string url_of(const boost::asio::ip::tcp::acceptor& acceptor, const HttpSettings& settings);
/// With the outward host instead of any address.
std::string outward_url_of(const boost::asio::ip::tcp::acceptor& acceptor, const HttpSettings& settings);
bool allows_plaintext(const HttpSettings& settings, const boost::asio::ip::address& with);

}  // namespace rayfarm
