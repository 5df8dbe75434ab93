#include "master/http/client.h"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <exception>
#include <optional>

namespace rayfarm {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

struct Peer {
  std::string host, port;
};

Peer peer_of(const std::string& url) {
  const std::invalid_argument wrong("the master's address must look like http://127.0.0.1:5412, is " + url);
  if (!url.starts_with("http://")) throw wrong;
  std::string rest = url.substr(7);
  if (rest.ends_with('/')) rest.pop_back();
  const std::size_t colon = rest.find(':', rest.starts_with('[') ? rest.find(']') : 0);
  const std::string host = rest.substr(0, colon);
  const std::string port = colon == std::string::npos ? "80" : rest.substr(colon + 1);
  if (host.empty() || port.empty() || port.find_first_not_of("0123456789") != std::string::npos ||
      host.find_first_of("/?#@") != std::string::npos)
    throw wrong;
  return {host, port};
}

std::string without_brackets(const std::string& host) {
  return host.starts_with('[') ? host.substr(1, host.size() - 2) : host;
}

using Clock = std::chrono::steady_clock;

/// Moves the deadline with each step, however small: a film of gigabytes takes as long as it takes.
asio::awaitable<HttpReply> exchange(const HttpRequest& asked, const Peer& peer, beast::tcp_stream& stream,
                                    Clock::time_point& deadline) {
  tcp::resolver resolver(stream.get_executor());
  const std::string host = without_brackets(peer.host);
  const tcp::resolver::results_type places =
      co_await resolver.async_resolve(host, peer.port, asio::use_awaitable);
  co_await stream.async_connect(places, asio::use_awaitable);
  deadline = Clock::now() + asked.patience;

  http::request<http::string_body> request(http::string_to_verb(asked.method), asked.target, 11, asked.body);
  request.set(http::field::host, peer.host + ":" + peer.port);
  request.set(http::field::user_agent, "rayfarm/" RAYFARM_VERSION);
  request.set(http::field::content_type, "application/json");
  request.keep_alive(false);
  request.prepare_payload();
  http::request_serializer<http::string_body> serializer(request);
  while (!serializer.is_done()) {
    co_await http::async_write_some(stream, serializer, asio::use_awaitable);
    deadline = Clock::now() + asked.patience;
  }

  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(boost::none);  // a film of 500 megapixels has gigabytes
  parser.eager(true);
  while (!parser.is_done()) {
    co_await http::async_read_some(stream, buffer, parser, asio::use_awaitable);
    deadline = Clock::now() + asked.patience;
  }
  http::response<http::string_body> response = parser.release();
  co_return HttpReply{response.result_int(), std::move(response.body())};
}

}  // namespace

HttpReply send(const HttpRequest& request) {
  constexpr auto glance = std::chrono::milliseconds(50);
  const Peer peer = peer_of(request.url);
  asio::io_context io(1);
  beast::tcp_stream stream(io);
  std::optional<HttpReply> reply;
  std::exception_ptr failure;
  Clock::time_point deadline = Clock::now() + request.patience;
  asio::co_spawn(io, exchange(request, peer, stream, deadline),
                 [&](std::exception_ptr error, HttpReply received) {
                   failure = error;
                   reply = std::move(received);
                 });
  while (!reply) {
    io.run_for(glance);
    if (!reply && Clock::now() > deadline)
      throw RequestTimedOut("the master at " + request.url + " took too long");
    if (request.cancelled()) throw RequestCancelled("interrupted");
  }
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const boost::system::system_error& error) {
    throw MasterUnreachable("no master answers at " + request.url + " (" + error.code().message() + ")");
  }
  return std::move(*reply);
}

}  // namespace rayfarm
