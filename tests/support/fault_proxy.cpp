#include "tests/support/fault_proxy.h"

#include <poll.h>

#include <algorithm>
#include <asio/connect.hpp>
#include <asio/write.hpp>
#include <random>

namespace rayfarm {
namespace {

using namespace std::chrono_literals;
using tcp = FaultProxy::tcp;

/// Which of two sockets have something to read, or have ended; none within a glance's length.
std::array<bool, 2> readable(std::array<pollfd, 2> sockets) {
  ::poll(sockets.data(), sockets.size(), 20);
  return {sockets[0].revents != 0, sockets[1].revents != 0};
}

std::string name_of(Mishap mishap) {
  constexpr std::array names{"none", "late", "slow", "narrow", "cut", "flip", "silent", "twin"};
  return names[static_cast<std::size_t>(mishap)];
}

}  // namespace

/// A connection that is carried: both ends, and what becomes of the bytes between them.
class FaultProxy::Connection {
 public:
  Connection(FaultProxy& proxy, tcp::socket client, const Fate& fate)
      : proxy_(proxy), fate_(fate), client_(std::move(client)), target_(proxy.io_), twin_(proxy.io_) {}

  void carry() {
    target_.connect(proxy_.target_);
    if (fate_.mishap == Mishap::twin) twin_.connect(proxy_.target_);
    while (!proxy_.ends_ && !(proxy_.is_calm_ && fate_.mishap != Mishap::none)) {
      const auto [from_client, from_target] =
          readable({pollfd{client_.native_handle(), POLLIN, 0}, {target_.native_handle(), POLLIN, 0}});
      if (from_client && !pass(Way::to_target, client_, target_)) return;
      if (from_target && !pass(Way::back, target_, client_)) return;
    }
  }

 private:
  /// False when the connection has ended.
  bool pass(Way way, tcp::socket& from, tcp::socket& to) {
    std::array<char, 16384> bytes;
    asio::error_code error;
    const std::size_t size = from.read_some(asio::buffer(bytes), error);
    if (error) return false;
    if (way == Way::to_target && twin_.is_open()) asio::write(twin_, asio::buffer(bytes, size), error);
    const std::uint64_t before = passed_[static_cast<std::size_t>(way)];
    passed_[static_cast<std::size_t>(way)] += size;
    const bool happens = way == fate_.way && before + size > fate_.bytes;
    const std::size_t unhurt = before < fate_.bytes ? fate_.bytes - before : 0;
    switch (fate_.mishap) {
      case Mishap::slow:
        std::this_thread::sleep_for(fate_.delay);
        break;
      case Mishap::narrow:
        std::this_thread::sleep_for(1us * (1'000'000 * size / fate_.bytes_per_second));
        break;
      case Mishap::cut:
        if (!happens) break;
        asio::write(to, asio::buffer(bytes, unhurt), error);
        return false;
      case Mishap::flip:
        if (happens && before <= fate_.bytes) bytes[unhurt] ^= 1 << fate_.bytes % 8;
        break;
      case Mishap::silent:
        if (happens) return true;
        break;
      case Mishap::none:
      case Mishap::late:
      case Mishap::twin:
        break;
    }
    asio::write(to, asio::buffer(bytes, size), error);
    return !error;
  }

  FaultProxy& proxy_;
  const Fate& fate_;
  tcp::socket client_, target_, twin_;
  std::array<std::uint64_t, 2> passed_{};  // bytes of each way
};

FaultProxy::Fate FaultProxy::fate_of(std::uint64_t seed, std::uint64_t number) {
  std::seed_seq seeds{seed, number};
  std::mt19937_64 random(seeds);
  const auto below = [&](std::uint64_t n) { return random() % n; };
  Fate fate;
  fate.mishap = static_cast<Mishap>(below(8));
  fate.way = below(2) ? Way::to_target : Way::back;
  fate.bytes = below(std::uint64_t{1} << (4 + below(14)));  // from within a header to many tiles
  fate.delay = (fate.mishap == Mishap::late ? 1ms * below(500) : 1ms * below(40));
  fate.bytes_per_second = 100'000 + below(1'000'000);
  return fate;
}

std::string FaultProxy::told(std::uint64_t number, const Fate& fate) {
  return "connection " + std::to_string(number) + ": " + name_of(fate.mishap) + " after " +
         std::to_string(fate.bytes) + " bytes " + (fate.way == Way::back ? "back" : "to the target") + ", " +
         std::to_string(fate.delay.count()) + " ms, " + std::to_string(fate.bytes_per_second) + " B/s\n";
}

FaultProxy::FaultProxy(const Address& target, std::uint64_t seed)
    : target_(asio::ip::make_address(target.host), target.port),
      acceptor_(io_, tcp::endpoint(asio::ip::address_v4::loopback(), 0)),
      thread_([this, seed] { accept_all(seed); }) {}

FaultProxy::~FaultProxy() {
  ends_ = true;
  thread_.join();
  for (std::thread& carrier : carriers_) carrier.join();
}

std::string FaultProxy::address() const {
  return "127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port());
}

std::string FaultProxy::story() const {
  const std::lock_guard lock(mutex_);
  return story_;
}

void FaultProxy::accept_all(std::uint64_t seed) {
  for (std::uint64_t number = 0; !ends_;) {
    const pollfd nothing{-1, 0, 0};
    if (!readable({pollfd{acceptor_.native_handle(), POLLIN, 0}, nothing})[0]) continue;
    tcp::socket client = acceptor_.accept();
    Fate fate = fate_of(seed, number);
    if (is_calm_) fate.mishap = Mishap::none;
    const std::lock_guard lock(mutex_);
    story_ += told(number, fate);
    carriers_.emplace_back(
        [this, fate, socket = std::move(client)]() mutable { carry(std::move(socket), fate); });
    ++number;
  }
}

void FaultProxy::carry(tcp::socket client, const Fate& fate) {
  if (fate.mishap == Mishap::late) std::this_thread::sleep_for(fate.delay);
  try {
    Connection(*this, std::move(client), fate).carry();
  } catch (const asio::system_error&) {
    // The target is not there, or has gone: the client is let go as well.
  }
}

}  // namespace rayfarm
