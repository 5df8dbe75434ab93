// A bad network: carries TCP connections to a target, and hurts them. What happens to a connection follows from the
// seed and its number.
#pragma once
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <list>
#include <mutex>
#include <string>
#include <thread>

#include "common/net/address.h"

namespace rayfarm {

enum class Mishap : std::uint8_t {
  none,
  late,    // comes to the target some time after it was made, behind later ones
  slow,    // what is sent arrives some time later
  narrow,  // passes few bytes a second
  cut,     // ends after some bytes of one direction, mostly in the middle of a frame
  flip,    // one bit of one direction is turned
  silent,  // passes nothing in one direction after some bytes
  twin,    // the target hears it twice, on two connections
};

class FaultProxy {
 public:
  using tcp = asio::ip::tcp;

  /// It listens on loopback; the target, too, is there.
  FaultProxy(const Address& target, std::uint64_t seed);
  /// Ends all connections.
  ~FaultProxy();

  /// HOST:PORT, to be dialled in the target's place.
  std::string address() const;
  /// From now on nothing happens any more: connections that have been hurt are ended, new ones are carried well.
  void calm() { is_calm_ = true; }
  /// What happened so far, for who wants to know why: "3 cut after 5210 bytes to the target\n".
  std::string story() const;

 private:
  enum class Way : std::uint8_t { to_target, back };
  struct Fate {
    Mishap mishap;
    Way way;
    std::uint64_t bytes;  // of that way that pass before it happens
    std::chrono::milliseconds delay;
    std::uint64_t bytes_per_second;
  };
  static Fate fate_of(std::uint64_t seed, std::uint64_t number);
  static std::string told(std::uint64_t number, const Fate& fate);

  class Connection;
  void accept_all(std::uint64_t seed);
  void carry(tcp::socket client, const Fate& fate);

  asio::io_context io_;
  const tcp::endpoint target_;
  tcp::acceptor acceptor_;
  std::atomic<bool> is_calm_ = false, ends_ = false;
  mutable std::mutex mutex_;  // guards what follows
  std::string story_;
  std::list<std::thread> carriers_;
  std::thread thread_;
};

}  // namespace rayfarm
