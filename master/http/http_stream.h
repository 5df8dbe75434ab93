// A connection of the HTTP server, plaintext or TLS: those who use it do not know which.
#pragma once
#include <boost/asio/async_result.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <utility>
#include <variant>

namespace rayfarm {

/// What Beast calls an AsyncStream.
class HttpStream {
 public:
  using Plain = boost::beast::tcp_stream;
  using Tls = boost::beast::ssl_stream<Plain>;
  using executor_type = Plain::executor_type;

  explicit HttpStream(Plain stream) : any_(std::move(stream)) {}

  /// What comes from now on is TLS; the handshake is still to be made.
  Tls& encrypt(boost::asio::ssl::context& context) {
    Plain plain = std::get<Plain>(std::move(any_));
    return any_.emplace<Tls>(std::move(plain), context);
  }
  /// Null: plaintext.
  Tls* tls() { return std::get_if<Tls>(&any_); }

  Plain& next_layer() { return tls() ? tls()->next_layer() : std::get<Plain>(any_); }
  const Plain& next_layer() const { return const_cast<HttpStream*>(this)->next_layer(); }
  executor_type get_executor() { return next_layer().get_executor(); }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(boost::system::error_code, std::size_t)>(
        [this](auto&& handler, const Buffers& into) {
          std::visit([&](auto& s) { s.async_read_some(into, std::forward<decltype(handler)>(handler)); },
                     any_);
        },
        token, buffers);
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(boost::system::error_code, std::size_t)>(
        [this](auto&& handler, const Buffers& from) {
          std::visit([&](auto& s) { s.async_write_some(from, std::forward<decltype(handler)>(handler)); },
                     any_);
        },
        token, buffers);
  }

  /// Found by Beast's WebSocket when it ends.
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, HttpStream& stream, Handler&& handler) {
    using boost::beast::websocket::async_teardown;
    std::visit([&](auto& s) { async_teardown(role, s, std::forward<Handler>(handler)); }, stream.any_);
  }

 private:
  std::variant<Plain, Tls> any_;
};

}  // namespace rayfarm
