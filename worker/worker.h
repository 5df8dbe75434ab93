// The worker: keeps a conversation with its master going, whatever happens, until it is stopped.
#pragma once
#include <asio/io_context.hpp>
#include <memory>
#include <optional>
#include <random>
#include <variant>

#include "common/net/backoff.h"
#include "common/net/dial.h"
#include "common/net/stranger_log.h"
#include "worker/session.h"

namespace rayfarm {

struct DialMaster {
  Address master;
};
struct AwaitMaster {
  Address listen;
};

struct WorkerOptions {
  std::variant<DialMaster, AwaitMaster> way;
  WorkerIdentity identity;
  Security security;
  SessionTimes times;
  BackoffTimes backoff;
};

/// All calls are made from the thread that runs `io`. (A Worker is what a farm knows of one.)
class WorkerDaemon {
 public:
  /// Throws AddressError when it cannot listen where it should.
  WorkerDaemon(asio::io_context& io, WorkerOptions options, PrepareScene prepare = prepare_scene);

  /// Returns after a clean stop; throws ExposureError when it would take a certificate to talk to the master, and
  /// there is none.
  asio::awaitable<void> run();
  void stop();

  /// Where it listens, if it does.
  std::optional<Address> listening_at() const;

 private:
  asio::awaitable<void> keep_dialling(Address master);
  asio::awaitable<void> try_master(Address master);
  asio::awaitable<void> await_masters();
  asio::awaitable<void> serve_stranger(asio::ip::tcp::socket socket);
  asio::awaitable<void> talk(Channel channel);
  asio::awaitable<void> decline(Channel channel);
  asio::awaitable<void> wait_until_stopped();
  void report(const std::string& loss);

  asio::io_context& io_;
  WorkerOptions options_;
  Crew crew_;
  Backoff backoff_;
  std::optional<asio::ip::tcp::acceptor> acceptor_;
  std::shared_ptr<WorkerSession> session_;  // while there is one
  asio::steady_timer ended_;                // never expires: cancelled when a session ends, or all shall
  bool stopping_ = false;
  std::string last_loss_;
  StrangerLog strangers_refused_;
};

}  // namespace rayfarm
