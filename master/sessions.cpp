#include "master/sessions.h"

#include <algorithm>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/redirect_error.hpp>

#include "common/net/until_first_ends.h"
#include "common/work/engine.h"
#include "master/hand_in.h"
#include "master/objection.h"

namespace rayfarm {
namespace {

using asio::ip::tcp;

constexpr std::chrono::milliseconds between_ticks{100};

/// Of ADDRESS:PORT.
std::string without_port(const std::string& peer) { return peer.substr(0, peer.rfind(':')); }

}  // namespace

DialTarget parse_dial_target(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string_view::npos)
    throw AddressError("\"" + std::string(text) +
                       "\" is no worker to dial: write NAME=HOST or NAME=HOST:PORT");
  return {std::string(text.substr(0, equals)), parse_address(text.substr(equals + 1), default_farm_port)};
}

struct Sessions::Session {
  WorkerConnection connection;
  const Dialled* dialled;          // null: it came by itself
  std::optional<WorkerId> worker;  // once it is admitted
  std::string farewell;            // what it said when it went

  const std::optional<PeerCertificate>& certificate() const { return connection.channel().peer(); }
  /// Encrypted, and it has shown no certificate: it may ask for one, and for nothing else.
  bool is_strangers() const { return connection.channel().is_encrypted() && !certificate(); }
};

struct Sessions::Dialled {
  DialTarget target;
  asio::steady_timer pause;  // between two tries
  std::string fault{};       // of the last try
  bool is_wanted = true;     // else it goes when its try has ended
};

Sessions::Sessions(asio::io_context& io, LiveFarm& farm, const Address& listen, Security security,
                   DoorTimes times, Access* access)
    : io_(io),
      farm_(farm),
      security_(std::move(security)),
      times_(times),
      access_(access),
      acceptor_(listen_at(io, listen, security_)),
      listening_at_{acceptor_.local_endpoint().address().to_string(), acceptor_.local_endpoint().port()},
      ended_(io, std::chrono::steady_clock::time_point::max()) {
  engine_fingerprint();  // rendered now, not while the first worker waits
}

Sessions::~Sessions() = default;

asio::awaitable<void> Sessions::run() { return until_first_ends(accept_all(), tick(), wait_until_stopped()); }

void Sessions::stop() {
  stopping_ = true;
  for (Session* session : sessions_) {
    session->connection.post(Goodbye{"the master stops"});
    session->connection.finish();
  }
  ended_.cancel();
}

asio::awaitable<void> Sessions::wait_until_stopped() {
  while (!stopping_ || !sessions_.empty()) {
    asio::error_code woken;
    co_await ended_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  }
}

// How workers come. ----------------------------------------------------------------------------------------

asio::awaitable<void> Sessions::accept_all() {
  for (;;) {
    tcp::socket socket = co_await accept(acceptor_);
    asio::co_spawn(io_, serve_stranger(std::move(socket)), asio::detached);
  }
}

/// The farm has no clock of its own.
asio::awaitable<void> Sessions::tick() {
  asio::steady_timer timer(io_);
  for (;;) {
    timer.expires_after(between_ticks);
    co_await timer.async_wait(asio::use_awaitable);
    farm_.apply([](Farm& farm, FarmTime now) { farm.tick(now); });
  }
}

asio::awaitable<void> Sessions::serve_stranger(tcp::socket socket) {
  asio::error_code unknown;
  const tcp::endpoint peer = socket.remote_endpoint(unknown);
  auto attempt = try_stranger(std::move(socket));
  const std::string fault = co_await std::move(attempt);
  if (fault.empty()) co_return;
  std::string line = "no worker at " + peer.address().to_string() + ": " + fault;
  if (line == last_stranger_) co_return;
  last_stranger_ = line;
  farm_.note({true, std::move(line), ""});
}

/// Why it was not admitted; empty when it was.
asio::awaitable<std::string> Sessions::try_stranger(tcp::socket socket) {
  std::string fault;
  try {
    std::optional<Channel> channel;
    auto greeting = until_first_ends(receive(channel, std::move(socket)), wait_until_stopping());
    co_await std::move(greeting);
    if (!channel) co_return "";
    auto serving = serve(std::move(*channel), nullptr);
    fault = co_await std::move(serving);
  } catch (const ConnectionLost& error) {
    fault = error.what();
  }
  co_return fault;
}

asio::awaitable<void> Sessions::receive(std::optional<Channel>& channel, tcp::socket socket) {
  auto greeting = greet(std::move(socket), security_, times_.connection.handshake);
  channel = co_await std::move(greeting);
}

asio::awaitable<void> Sessions::wait_until_stopping() {
  while (!stopping_) {
    asio::error_code woken;
    co_await ended_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  }
}

void Sessions::dial(DialTarget target) {
  expect_free(target.name);
  const auto dialled = dialled_.insert(dialled_.end(), {std::move(target), asio::steady_timer(io_)});
  asio::co_spawn(io_, keep_dialled(dialled), asio::detached);
}

void Sessions::expect_free(const std::string& name) const {
  for (const Dialled& dialled : dialled_)
    if (dialled.is_wanted && dialled.target.name == name)
      throw NameInUse("\"" + name + "\" is dialled already, at " + text_of(dialled.target.address) +
                      ": stop that first (DELETE /api/v1/workers/dial/" + name + "), or choose another name");
  farm_.apply([&](Farm& farm, FarmTime) {
    for (const WorkerView& worker : farm.workers())
      if (worker.info.name == name)
        throw NameInUse("a worker \"" + name + "\" is here already; dial the new one by another name");
    if (const auto objection = farm.objection_to(name)) throw NameInUse(*objection);
  });
}

bool Sessions::stop_dialling(const std::string& name) {
  const auto is_meant = [&](const Dialled& d) { return d.is_wanted && d.target.name == name; };
  const auto dialled = std::ranges::find_if(dialled_, is_meant);
  if (dialled == dialled_.end()) return false;
  dialled->is_wanted = false;
  dialled->pause.cancel();
  return true;
}

std::vector<Dialling> Sessions::dialling() const {
  std::vector<Dialling> all;
  for (const Dialled& dialled : dialled_) {
    const auto is_reached = [&](const Session* s) { return s->dialled == &dialled && s->worker; };
    if (!dialled.is_wanted || std::ranges::any_of(sessions_, is_reached)) continue;
    all.push_back({dialled.target.name, text_of(dialled.target.address), dialled.fault});
  }
  return all;
}

asio::awaitable<void> Sessions::keep_dialled(std::list<Dialled>::iterator place) {
  Dialled& dialled = *place;
  Backoff backoff(times_.backoff, std::random_device{}());
  while (!stopping_ && dialled.is_wanted) {
    const auto begun = std::chrono::steady_clock::now();
    auto attempt = try_target(dialled);
    const std::string fault = co_await std::move(attempt);
    // One that ends sooner is no success: a worker that lies at once is not dialled without pause.
    const bool lasted = std::chrono::steady_clock::now() - begun > times_.backoff.longest;
    if (fault.empty() && lasted) backoff.reset();
    const std::string& name = dialled.target.name;
    if (!dialled.is_wanted) break;
    if (!fault.empty() && fault != dialled.fault)
      farm_.note({true, "worker \"" + name + "\": " + fault + "; trying again", name});
    dialled.fault = fault;
    dialled.pause.expires_after(backoff.next());
    asio::error_code woken;
    co_await dialled.pause.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  }
  dialled_.erase(place);
}

/// Why there was no worker; empty after one that there was has gone.
asio::awaitable<std::string> Sessions::try_target(const Dialled& dialled) {
  std::string fault;
  try {
    auto dialling = rayfarm::dial(dialled.target.address, security_, times_.connection.handshake);
    Channel channel = co_await std::move(dialling);
    auto serving = serve(std::move(channel), &dialled);
    fault = co_await std::move(serving);
  } catch (const AddressError& error) {
    fault = error.what();
  } catch (const ConnectionLost& error) {
    fault = error.what();
  }
  co_return fault;
}

// A conversation. ------------------------------------------------------------------------------------------

/// Why the peer was not admitted; empty after the conversation with one that was.
asio::awaitable<std::string> Sessions::serve(Channel channel, const Dialled* dialled) {
  if (stopping_) co_return "the master stops";
  Session session{{std::move(channel), times_.connection}, dialled, {}, {}};
  sessions_.insert(&session);
  if (dialled) session.connection.post(Heartbeat{});  // who dials begins: what comes tells plaintext from TLS
  std::string reason;
  FarmTime silence{};
  try {
    auto loops = until_first_ends(session.connection.tend(), converse(session));
    co_await std::move(loops);
    reason = stopping_ ? "the master stops" : session.farewell;
  } catch (const PeerSilent& error) {
    reason = error.what();
    silence = times_.connection.silence;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  sessions_.erase(&session);
  ended_.cancel();
  if (!session.worker) co_return reason;
  farm_.apply([&](Farm& farm, FarmTime now) {
    if (stopping_) farm.receive(*session.worker, GiveBack{}, now);  // it is not lost, we stop
    farm.remove_worker(*session.worker, reason, now, silence);
  });
  co_return "";
}

asio::awaitable<void> Sessions::converse(Session& session) {
  session.connection.expect_message_within(times_.connection.handshake);
  try {
    const ToMaster first = co_await session.connection.receive();
    open(session, first);
  } catch (const CodecError& error) {
    if (session.is_strangers()) throw;
    refuse(session, error.what());
  }
  if (!session.worker) co_await session.connection.wait_for_end();
  for (;;) {
    ToMaster message = co_await session.connection.receive();
    if (const auto* goodbye = std::get_if<Goodbye>(&message)) {
      session.farewell = "it said goodbye: " + goodbye->reason;
      co_return;
    }
    hand_in(farm_, *session.worker, std::move(message));
  }
}

void Sessions::open(Session& session, const ToMaster& first) {
  if (session.is_strangers()) return pair(session, first);
  check_certificate(session);
  const std::string objection = objection_to(first);
  if (objection.empty())
    admit(session, std::get<Hello>(first));
  else
    refuse(session, objection);
}

/// Who brings no certificate and no good code learns nothing, not even why.
void Sessions::pair(Session& session, const ToMaster& first) {
  const auto* join = std::get_if<Join>(&first);
  if (!join) throw ConnectionLost("it showed no certificate");
  if (const std::string objection = objection_to(join->versions, join->software); !objection.empty())
    return refuse(session, objection);
  if (!access_) throw ConnectionLost("it wants to be paired, and this master keeps no codes");
  const std::string& peer = session.connection.peer();
  const std::string made = access_->pair(*join, without_port(peer), std::chrono::system_clock::now());
  farm_.note({false, "worker " + join->name + " at " + peer + " was paired", join->name});
  session.connection.post(Paired{{made.begin(), made.end()}});
  session.connection.finish();
}

void Sessions::check_certificate(const Session& session) const try {
  if (!session.certificate() || !access_) return;
  access_->check_worker(session.certificate()->facts, std::chrono::system_clock::now());
} catch (const AccessRefused& refused) {
  throw ConnectionLost("the certificate of \"" + session.certificate()->facts.name +
                       "\" is refused: " + refused.what());
}

void Sessions::cut_off(const std::set<std::string>& certificates) {
  for (Session* session : sessions_)
    if (session->certificate() && certificates.contains(session->certificate()->facts.id))
      session->connection.close("its certificate was revoked");
}

void Sessions::refuse(Session& session, const std::string& objection) {
  session.farewell = objection;
  session.connection.post(Refused{objection});
  session.connection.finish();
}

void Sessions::admit(Session& session, const Hello& hello) {
  if (session.dialled && !session.dialled->is_wanted) return refuse(session, "it is no longer dialled");
  const std::string& name = session.dialled ? session.dialled->target.name : hello.name;
  const std::string certificate = session.certificate() ? session.certificate()->facts.id : "";
  const auto objection =
      farm_.apply([&](Farm& farm, FarmTime) { return farm.objection_to(name, certificate); });
  if (objection) return refuse(session, *objection);
  const Versions versions = *common_versions(hello.versions, {});
  const bool takes_pieces = (versions.capabilities & can_take_pieces) != 0;
  const WorkerInfo info{name,          session.connection.peer(), hello.cpu,     hello.software,
                        hello.threads, WorkerKind::remote,        hello.process, certificate,
                        takes_pieces};
  const auto send = [&session, this, versions](ToWorker message) {
    if (const auto* refused = std::get_if<Refused>(&message)) return refuse(session, refused->reason);
    if (auto* welcome = std::get_if<Welcome>(&message)) welcome->versions = versions;
    session.connection.post(message);
    if (std::holds_alternative<Goodbye>(message)) session.connection.finish();
  };
  session.worker = farm_.apply([&](Farm& farm, FarmTime now) { return farm.add_worker(info, send, now); });
}

}  // namespace rayfarm
