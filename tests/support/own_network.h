// A network without others, and all that is said in it.
#pragma once
#include <cstdint>
#include <map>
#include <string>

namespace rayfarm {

/// This process has a network of its own from now on, with loopback and `address`. errno when this machine allows none.
int enter_own_network(const std::string& address);

/// All TCP over IPv4 from now on. Throws std::runtime_error.
class PacketCapture {
 public:
  PacketCapture();
  ~PacketCapture();
  PacketCapture(const PacketCapture&) = delete;
  PacketCapture& operator=(const PacketCapture&) = delete;

  /// What went each way since the last call, by "ADDRESS:PORT > ADDRESS:PORT", without what went over 127.0.0.1. Throws
  /// when some of it was missed.
  std::map<std::string, std::string> streams();

 private:
  int socket_;
};

}  // namespace rayfarm
