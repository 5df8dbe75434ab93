// The bytes of a connection, plaintext or TLS 1.3: those who talk over it do not know which.
//
// OpenSSL reads and writes the socket itself when Asio says that it can: asio::ssl::stream copies through 70 KB of
// buffers for each connection, and its operations cannot be cancelled one by one.
#pragma once
#include <asio/awaitable.hpp>
#include <asio/buffer.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/system_error.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/net/tls.h"

namespace rayfarm {

/// The connection ended; the message says why, as in "lab7 was lost: ...".
struct ConnectionLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// Nobody knows since when it has heard nothing, either.
struct PeerSilent : ConnectionLost {
  using ConnectionLost::ConnectionLost;
};

/// Throws ConnectionLost with what this error of a channel means.
[[noreturn]] void lose(const asio::system_error& error);

/// One coroutine may read while another one writes. What ends a connection is thrown as asio::system_error, whatever it
/// is; ConnectionLost when it is the encryption.
class Channel {
 public:
  /// Plaintext.
  Channel(asio::ip::tcp::socket socket);
  Channel(Channel&&) noexcept;
  Channel& operator=(Channel&&) noexcept;
  ~Channel();

  /// At least one byte, at most as many as there is room for.
  asio::awaitable<std::size_t> read_some(asio::mutable_buffer room);
  /// All of it.
  asio::awaitable<void> write(const std::vector<asio::const_buffer>& buffers);
  /// Tells the other side that nothing more is to come.
  void end_writing();

  bool is_encrypted() const { return tls_ != nullptr; }
  /// Of an encrypted channel whose other side showed one.
  const std::optional<PeerCertificate>& peer() const { return peer_; }
  /// Of an encrypted channel: see authority_behind() in tls.h.
  std::string authority_behind(const std::string& fingerprint) const;
  /// The other end, as ADDRESS:PORT.
  std::string address() const;
  asio::any_io_executor executor() { return socket_.get_executor(); }

 private:
  struct FreeTls {
    void operator()(ssl_st* tls) const;
  };
  friend asio::awaitable<Channel> encrypt_accepted(asio::ip::tcp::socket socket, TlsContext context);
  friend asio::awaitable<Channel> encrypt_dialled(asio::ip::tcp::socket socket, TlsContext context);

  Channel(asio::ip::tcp::socket socket, const TlsContext& context);
  asio::awaitable<void> shake_hands(TlsContext context);
  asio::awaitable<std::size_t> read_decrypted(asio::mutable_buffer room);
  asio::awaitable<void> write_encrypted(const std::vector<asio::const_buffer>& buffers);
  asio::ip::tcp::socket::wait_type wish_after(int result) const;

  asio::ip::tcp::socket socket_;
  std::unique_ptr<ssl_st, FreeTls> tls_;  // null: plaintext
  std::optional<PeerCertificate> peer_;
};

/// The handshake over a socket that was accepted, or dialled. The deadline is the caller's. What the other side shows
/// stands in peer() and is not judged here.
asio::awaitable<Channel> encrypt_accepted(asio::ip::tcp::socket socket, TlsContext context);
asio::awaitable<Channel> encrypt_dialled(asio::ip::tcp::socket socket, TlsContext context);

}  // namespace rayfarm
