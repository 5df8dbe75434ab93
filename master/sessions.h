// The master's door for workers: listens, dials, and translates between connections and the farm.
#pragma once
#include <asio/io_context.hpp>
#include <list>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "common/net/backoff.h"
#include "common/net/connection.h"
#include "common/net/dial.h"
#include "common/net/open_socket.h"
#include "common/net/stranger_log.h"
#include "master/access/access.h"
#include "master/dialling.h"
#include "master/live_farm.h"

namespace rayfarm {

/// A worker that waits to be dialled; the farm calls it by this name.
struct DialTarget {
  std::string name;
  Address address;
};
/// NAME=HOST[:PORT]. Throws AddressError.
DialTarget parse_dial_target(std::string_view text);

struct DoorLimits {
  ConnectionTimes connection;
  BackoffTimes backoff;
  std::size_t strangers = 1024;  // at once, who are no workers yet; for one more the oldest goes
};

/// All calls are made from the thread that runs `io`, which is the farm's.
class Sessions {
 public:
  /// Listens from now on; throws AddressError when it cannot. `access` says which certificates are still good, and
  /// makes new ones for those who bring a code; without it nobody is paired.
  Sessions(asio::io_context& io, LiveFarm& farm, const Address& listen, Security security,
           DoorLimits limits = {}, Access* access = nullptr);
  ~Sessions();

  const Address& listening_at() const { return listening_at_; }
  /// Dials, and again whenever the worker is lost. Why it cannot be reached is logged, once for each reason. Throws
  /// NameInUse when a worker of that name is here, dialled or banned.
  void dial(DialTarget target);
  /// A worker that is reached stays until it goes. False: the name is not dialled.
  bool stop_dialling(const std::string& name);
  /// Ends the connections of workers with these certificates, by their id.
  void cut_off(const std::set<std::string>& certificates);
  /// Those that are dialled and not reached just now.
  std::vector<Dialling> dialling() const;
  /// Takes workers in. Returns after stop(), once all are gone.
  asio::awaitable<void> run();
  /// Says goodbye to all.
  void stop();

 private:
  struct Session;
  struct Dialled;
  struct Stranger {
    OpenSocket socket;
    bool is_leaving = false;
  };
  class Visit;

  asio::awaitable<void> accept_all();
  asio::awaitable<void> tick();
  void expect_free(const std::string& name) const;
  asio::awaitable<void> keep_dialled(std::list<Dialled>::iterator dialled);
  asio::awaitable<std::string> try_target(const Dialled& dialled);
  asio::awaitable<void> serve_stranger(asio::ip::tcp::socket socket);
  asio::awaitable<std::string> try_stranger(asio::ip::tcp::socket socket);
  asio::awaitable<void> receive(std::optional<Channel>& channel, asio::ip::tcp::socket socket);
  asio::awaitable<void> wait_until_stopping();
  asio::awaitable<std::string> serve(Channel channel, const Dialled* dialled, Visit* visit);
  asio::awaitable<void> converse(Session& session);
  void open(Session& session, const ToMaster& first);
  void pair(Session& session, const ToMaster& first);
  void check_certificate(const Session& session) const;
  void admit(Session& session, const Hello& hello);
  void refuse(Session& session, const std::string& objection);
  asio::awaitable<void> wait_until_stopped();

  asio::io_context& io_;
  LiveFarm& farm_;
  Security security_;
  DoorLimits limits_;
  Access* const access_;
  asio::ip::tcp::acceptor acceptor_;
  Address listening_at_;
  std::set<Session*> sessions_;
  std::list<Dialled> dialled_;
  const std::shared_ptr<std::list<Stranger>> strangers_;  // the oldest first; visits may outlive us
  StrangerLog strangers_refused_;
  asio::steady_timer ended_;  // never expires: cancelled when a session ends, or all shall
  bool stopping_ = false;
};

}  // namespace rayfarm
