// A connection as others than its owner know it.
#pragma once
#include <sys/socket.h>

#include <cstring>

namespace rayfarm {

/// By its descriptor and its other end: once it is closed, the number may stand for another connection.
class OpenSocket {
 public:
  explicit OpenSocket(int descriptor) : descriptor_(descriptor), peer_(peer_of(descriptor)) {}

  /// Its owner reads the end next. Nothing when it is closed.
  void shut_down() const {
    const Peer now = peer_of(descriptor_);
    if (now.size > 0 && now.size == peer_.size && std::memcmp(&now.address, &peer_.address, now.size) == 0)
      ::shutdown(descriptor_, SHUT_RDWR);
  }

 private:
  struct Peer {
    sockaddr_storage address{};
    socklen_t size = 0;
  };
  static Peer peer_of(int descriptor) {
    Peer peer;
    peer.size = sizeof peer.address;
    if (::getpeername(descriptor, reinterpret_cast<sockaddr*>(&peer.address), &peer.size) != 0) peer.size = 0;
    return peer;
  }

  int descriptor_;
  Peer peer_;
};

}  // namespace rayfarm
