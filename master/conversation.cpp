// What is said with a worker, and with who would be one.
#include <limits>

#include "common/net/until_first_ends.h"
#include "master/hand_in.h"
#include "master/objection.h"
#include "master/session.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t longest_greeting = 16 << 10;  // bytes that who is nobody yet may have us keep

/// Of ADDRESS:PORT.
std::string without_port(const std::string& peer) { return peer.substr(0, peer.rfind(':')); }

}  // namespace

/// Why the peer was not admitted; empty after the conversation with one that was.
asio::awaitable<std::string> Sessions::serve(Channel channel, const Dialled* dialled, Visit* visit) {
  if (stopping_) co_return "the master stops";
  Session session{{std::move(channel), limits_.connection}, dialled, visit, {}, {}};
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
    silence = limits_.connection.silence;
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
  session.connection.expect_message_within(limits_.connection.handshake);
  session.connection.take_messages_up_to(longest_greeting);
  try {
    const ToMaster first = co_await session.connection.receive();
    open(session, first);
  } catch (const CodecError& error) {
    if (session.is_strangers()) throw;
    refuse(session, error.what());
  }
  if (!session.worker) co_await session.connection.wait_for_end();
  session.connection.take_messages_up_to(std::numeric_limits<std::uint32_t>::max());
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
  try {
    if (access_ && session.certificate() && !session.dialled)
      access_->check_name(session.certificate()->facts, name, std::chrono::system_clock::now());
  } catch (const AccessRefused& refused) {
    return refuse(session, refused.what());
  }
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
  if (session.visit) session.visit->end();
}

}  // namespace rayfarm
