#include "common/net/channel.h"

#include <sys/socket.h>

#include <array>
#include <asio/error.hpp>
#include <asio/post.hpp>
#include <asio/use_awaitable.hpp>
#include <asio/write.hpp>
#include <cerrno>
#include <cstring>

#include "common/net/openssl_ptr.h"

namespace rayfarm {
namespace {

using asio::ip::tcp;

constexpr std::size_t record_size = SSL3_RT_MAX_PLAIN_LENGTH;  // the largest that TLS has

// A socket as OpenSSL sees it. Its own would raise SIGPIPE when the other side has gone. ------------------

int descriptor_of(BIO* bio) { return static_cast<int>(reinterpret_cast<std::intptr_t>(BIO_get_data(bio))); }

bool shall_be_tried_again() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

int send_bytes(BIO* bio, const char* data, std::size_t size, std::size_t* sent) {
  BIO_clear_retry_flags(bio);
  const ssize_t n = ::send(descriptor_of(bio), data, size, MSG_NOSIGNAL);
  if (n < 0 && shall_be_tried_again()) BIO_set_retry_write(bio);
  *sent = n > 0 ? static_cast<std::size_t>(n) : 0;
  return n > 0;
}

int receive_bytes(BIO* bio, char* data, std::size_t size, std::size_t* received) {
  BIO_clear_retry_flags(bio);
  errno = 0;  // stays so at the end of the stream
  const ssize_t n = ::recv(descriptor_of(bio), data, size, 0);
  if (n < 0 && shall_be_tried_again()) BIO_set_retry_read(bio);
  *received = n > 0 ? static_cast<std::size_t>(n) : 0;
  return n > 0;
}

long control(BIO*, int command, long, void*) { return command == BIO_CTRL_FLUSH; }

BIO* new_socket_bio(int descriptor) {
  static BIO_METHOD* const method = [] {
    BIO_METHOD* made = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "socket");
    BIO_meth_set_write_ex(made, send_bytes);
    BIO_meth_set_read_ex(made, receive_bytes);
    BIO_meth_set_ctrl(made, control);
    return made;
  }();
  BIO* const bio = BIO_new(method);
  if (!bio) throw ConnectionLost("encryption failed: " + openssl_error());
  BIO_set_data(bio, reinterpret_cast<void*>(static_cast<std::intptr_t>(descriptor)));
  BIO_set_init(bio, 1);
  return bio;
}

/// As much of the buffers as one record takes: small ones share it.
class RecordFiller {
 public:
  explicit RecordFiller(const std::vector<asio::const_buffer>& buffers) : rest_(buffers) {}

  /// 0: all has been taken.
  std::size_t fill(std::array<std::uint8_t, record_size>& record) {
    std::size_t filled = 0;
    while (filled < record.size() && next_ < rest_.size()) {
      const std::size_t taken = std::min(record.size() - filled, rest_[next_].size() - used_);
      std::memcpy(record.data() + filled, static_cast<const std::uint8_t*>(rest_[next_].data()) + used_,
                  taken);
      filled += taken, used_ += taken;
      if (used_ == rest_[next_].size()) ++next_, used_ = 0;
    }
    return filled;
  }

 private:
  const std::vector<asio::const_buffer>& rest_;
  std::size_t next_ = 0, used_ = 0;
};

}  // namespace

void lose(const asio::system_error& error) {
  throw ConnectionLost(error.code() == asio::error::eof ? "the other side closed the connection"
                                                        : error.code().message());
}

void Channel::FreeTls::operator()(ssl_st* tls) const { SSL_free(tls); }

Channel::Channel(tcp::socket socket) : socket_(std::move(socket)) {
  asio::error_code ignored;  // a connection that is gone already is noticed at the first read
  socket_.set_option(tcp::no_delay(true), ignored);
}

Channel::Channel(tcp::socket socket, const TlsContext& context) : Channel(std::move(socket)) {
  socket_.native_non_blocking(true);
  tls_.reset(SSL_new(context.get()));
  if (!tls_) throw ConnectionLost("encryption failed: " + openssl_error());
  BIO* const bio = new_socket_bio(socket_.native_handle());
  SSL_set_bio(tls_.get(), bio, bio);
}

Channel::Channel(Channel&&) noexcept = default;
Channel& Channel::operator=(Channel&&) noexcept = default;
Channel::~Channel() = default;

std::string Channel::address() const {
  asio::error_code error;
  const auto endpoint = socket_.remote_endpoint(error);
  if (error) return "unknown";
  const std::string address = endpoint.address().to_string();
  return (endpoint.address().is_v6() ? "[" + address + "]" : address) + ":" + std::to_string(endpoint.port());
}

std::string Channel::authority_behind(const std::string& fingerprint) const {
  return rayfarm::authority_behind(*tls_, fingerprint);
}

asio::awaitable<std::size_t> Channel::read_some(asio::mutable_buffer room) {
  return tls_ ? read_decrypted(room) : socket_.async_read_some(room, asio::use_awaitable);
}

asio::awaitable<void> Channel::write(const std::vector<asio::const_buffer>& buffers) {
  if (tls_)
    co_await write_encrypted(buffers);
  else
    co_await asio::async_write(socket_, buffers, asio::use_awaitable);
}

void Channel::end_writing() {
  if (tls_) SSL_shutdown(tls_.get());  // what does not fit into the socket's buffer is not worth waiting for
  ERR_clear_error();
}

// TLS. -----------------------------------------------------------------------------------------------------

/// After a call of OpenSSL's that came to nothing: what to wait for before it is called again.
tcp::socket::wait_type Channel::wish_after(int result) const {
  const int cause = errno;
  switch (SSL_get_error(tls_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      return tcp::socket::wait_read;
    case SSL_ERROR_WANT_WRITE:
      return tcp::socket::wait_write;
    case SSL_ERROR_ZERO_RETURN:
      throw asio::system_error(asio::error::eof);
    case SSL_ERROR_SYSCALL:
      throw asio::system_error(cause ? asio::error_code(cause, asio::system_category()) : asio::error::eof);
    default:
      throw ConnectionLost("encryption failed: " + openssl_error());
  }
}

asio::awaitable<std::size_t> Channel::read_decrypted(asio::mutable_buffer room) {
  auto* const bytes = static_cast<std::uint8_t*>(room.data());
  std::size_t count = 0;
  bool has_waited = false;
  for (;;) {
    ERR_clear_error();
    std::size_t some = 0;
    const int result = SSL_read_ex(tls_.get(), bytes + count, room.size() - count, &some);
    count += some;
    if (result == 1 && count < room.size()) continue;
    if (count > 0) break;
    const auto wish = wish_after(result);
    co_await socket_.async_wait(wish, asio::use_awaitable);
    has_waited = true;
  }
  // A peer that sends without end shall not have this thread for itself.
  if (!has_waited) co_await asio::post(executor(), asio::use_awaitable);
  co_return count;
}

asio::awaitable<void> Channel::write_encrypted(const std::vector<asio::const_buffer>& buffers) {
  std::array<std::uint8_t, record_size> record;
  RecordFiller filler(buffers);
  while (const std::size_t size = filler.fill(record)) {
    for (;;) {
      ERR_clear_error();
      std::size_t written = 0;
      const int result = SSL_write_ex(tls_.get(), record.data(), size, &written);
      if (result == 1) break;
      const auto wish = wish_after(result);
      co_await socket_.async_wait(wish, asio::use_awaitable);
    }
    if (size == record.size()) co_await asio::post(executor(), asio::use_awaitable);  // others have a turn
  }
}

asio::awaitable<void> Channel::shake_hands(TlsContext context) {
  for (;;) {
    ERR_clear_error();
    const int result = SSL_do_handshake(tls_.get());
    if (result == 1) break;
    const auto wish = wish_after(result);
    co_await socket_.async_wait(wish, asio::use_awaitable);
  }
  try {
    peer_ = peer_certificate(*tls_, context);
  } catch (const CertificateError& error) {
    throw ConnectionLost(std::string("its certificate cannot be read: ") + error.what());
  }
}

asio::awaitable<Channel> encrypt_accepted(tcp::socket socket, TlsContext context) {
  Channel channel(std::move(socket), context);
  SSL_set_accept_state(channel.tls_.get());
  auto handshake = channel.shake_hands(context);
  co_await std::move(handshake);
  co_return channel;
}

asio::awaitable<Channel> encrypt_dialled(tcp::socket socket, TlsContext context) {
  Channel channel(std::move(socket), context);
  SSL_set_connect_state(channel.tls_.get());
  auto handshake = channel.shake_hands(context);
  co_await std::move(handshake);
  co_return channel;
}

}  // namespace rayfarm
