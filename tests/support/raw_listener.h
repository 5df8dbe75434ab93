// A port where nobody speaks HTTP: what its one peer gets is up to the test.
#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace rayfarm {

class RawListener {
 public:
  RawListener() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(listener_, reinterpret_cast<sockaddr*>(&address), size);
    ::listen(listener_, 1);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }
  ~RawListener() {
    ::close(listener_);
    if (accepted()) ::close(peer_);
  }
  RawListener(const RawListener&) = delete;
  RawListener& operator=(const RawListener&) = delete;

  const std::string& url() const { return url_; }
  /// Takes the peer in if it is there.
  bool accept() { return (peer_ = ::accept(listener_, nullptr, nullptr)) >= 0; }
  bool accepted() const { return peer_ >= 0; }
  /// What it sends next; empty: it sends nothing more.
  std::string some() {
    char bytes[4096];
    const ssize_t n = ::recv(peer_, bytes, sizeof bytes, 0);
    return n > 0 ? std::string(bytes, static_cast<std::size_t>(n)) : "";
  }
  void send(const std::string& bytes) { ::send(peer_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }

 private:
  int listener_, peer_ = -1;
  std::string url_;
};

}  // namespace rayfarm
