#include "master/http/client.h"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <exception>
#include <optional>

#include "common/net/secrets.h"
#include "common/net/tls.h"
#include "master/http/http_stream.h"

namespace rayfarm {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

struct Peer {
  std::string host, port;
  bool is_encrypted = false;
};

bool is_on_this_pc(const std::string& host) {
  boost::system::error_code no_address;
  return host == "localhost" || host == "[::1]" || asio::ip::make_address_v4(host, no_address).is_loopback();
}

Peer peer_of(const std::string& url) {
  const std::invalid_argument wrong("the master's address must look like https://lab1:5412, is " + url);
  const bool is_encrypted = url.starts_with("https://");
  if (!is_encrypted && !url.starts_with("http://")) throw wrong;
  std::string rest = url.substr(is_encrypted ? 8 : 7);
  if (rest.ends_with('/')) rest.pop_back();
  const std::size_t colon = rest.find(':', rest.starts_with('[') ? rest.find(']') : 0);
  const std::string host = rest.substr(0, colon);
  const std::string port = colon != std::string::npos ? rest.substr(colon + 1) : is_encrypted ? "443" : "80";
  if (host.empty() || port.empty() || port.find_first_not_of("0123456789") != std::string::npos ||
      host.find_first_of("/?#@") != std::string::npos)
    throw wrong;
  return {host, port, is_encrypted};
}

std::string without_brackets(const std::string& host) {
  return host.starts_with('[') ? host.substr(1, host.size() - 2) : host;
}

using Clock = std::chrono::steady_clock;

http::request<http::string_body> message_of(const HttpRequest& asked, const Peer& peer) {
  http::request<http::string_body> request(http::string_to_verb(asked.method), asked.target, 11, asked.body);
  request.set(http::field::host, peer.host + ":" + peer.port);
  request.set(http::field::user_agent, "rayfarm/" RAYFARM_VERSION);
  request.set(http::field::content_type, "application/json");
  if (!asked.token.empty()) request.set(http::field::authorization, "Bearer " + asked.token);
  request.keep_alive(false);
  request.prepare_payload();
  return request;
}

/// The token names the farm that it is for; without one, this PC's authorities must know the host.
void expect_trusted(HttpStream::Tls& tls, const HttpRequest& asked, bool is_known_here) {
  if (is_known_here) return;
  if (asked.token.empty())
    throw MasterUntrusted("this PC does not know the certificate of the master at " + asked.url +
                          "; name the file with your token in RAYFARM_TOKEN_FILE");
  try {
    authority_behind(*tls.native_handle(), parse_token(asked.token).farm);
  } catch (const std::runtime_error& error) {
    throw MasterUntrusted("the master at " + asked.url + " is not the one that your token is for (" +
                          error.what() + "), or has a certificate of its own: ask for the name in that");
  }
}

/// With the authorities that this PC trusts: reading them takes 30 ms, so it is done once, and only where it is needed.
asio::ssl::context& tls_context() {
  static asio::ssl::context context = [] {
    asio::ssl::context made(asio::ssl::context::tlsv13_client);
    made.set_default_verify_paths();
    return made;
  }();
  return context;
}

asio::awaitable<void> encrypt(HttpStream& stream, const HttpRequest& asked, const Peer& peer) {
  HttpStream::Tls& tls = stream.encrypt(tls_context());
  const std::string host = without_brackets(peer.host);
  SSL_set_tlsext_host_name(tls.native_handle(), host.c_str());
  bool is_known_here = true;
  tls.set_verify_mode(asio::ssl::verify_peer);
  tls.set_verify_callback([&is_known_here, verify = asio::ssl::host_name_verification(host)](
                              bool is_good, asio::ssl::verify_context& at) mutable {
    is_known_here = verify(is_good, at) && is_known_here;
    return true;  // judged below, when all of the chain has come
  });
  co_await tls.async_handshake(asio::ssl::stream_base::client, asio::use_awaitable);
  expect_trusted(tls, asked, is_known_here);
}

/// Moves the deadline with each step, however small: a film of gigabytes takes as long as it takes.
asio::awaitable<HttpReply> exchange(const HttpRequest& asked, const Peer& peer, HttpStream& stream,
                                    Clock::time_point& deadline) {
  tcp::resolver resolver(stream.get_executor());
  const std::string host = without_brackets(peer.host);
  const tcp::resolver::results_type places =
      co_await resolver.async_resolve(host, peer.port, asio::use_awaitable);
  co_await stream.next_layer().async_connect(places, asio::use_awaitable);
  deadline = Clock::now() + asked.patience;
  if (peer.is_encrypted) co_await encrypt(stream, asked, peer);

  http::request<http::string_body> request = message_of(asked, peer);
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
  Peer peer = peer_of(request.url);
  if (!request.token.empty() && !peer.is_encrypted && !is_on_this_pc(peer.host))
    throw std::invalid_argument("the token would go to " + request.url +
                                " for everybody on the network to read; say https://");
  // While no master is up, any user of this PC may listen in its place; the farm's certificate only the master has.
  if (!request.token.empty()) peer.is_encrypted = true;
  asio::io_context io(1);
  HttpStream stream{beast::tcp_stream(io)};
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
    if (error.code() == http::error::end_of_stream && !peer.is_encrypted)
      throw MasterUnreachable("who is at " + request.url +
                              " answers nothing: a master that encrypts wants https://");
    const bool encrypts_unasked = peer.is_encrypted && request.url.starts_with("http://");
    throw MasterUnreachable(
        "no master answers at " + request.url + " (" + error.code().message() +
        (encrypts_unasked
             ? "; with a token it is asked over TLS alone: without RAYFARM_TOKEN_FILE also in plaintext)"
             : ")"));
  }
  return std::move(*reply);
}

}  // namespace rayfarm
