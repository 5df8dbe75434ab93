// Where the HTTP server listens.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "master/http/guard.h"
#include "master/http/server.h"

namespace rayfarm {

/// Throws HttpError.
boost::asio::ip::tcp::acceptor acceptor_at(boost::asio::io_context& io, const HttpSettings& settings);
ListenAddress address_of(const boost::asio::ip::tcp::acceptor& acceptor);
std::string url_of(const boost::asio::ip::tcp::acceptor& acceptor);

}  // namespace rayfarm
