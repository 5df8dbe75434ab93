// A network without others, and all that is said in it.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace rayfarm {

/// Runs it in a child process that has a network of its own, with loopback and `address`, and returns what that
/// answered (below 100), or -1 when this machine allows no such network: then `fault` says why.
int in_own_network(const std::string& address, const std::function<int()>& run, std::string& fault);

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
