#include "worker/session.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include <asio/post.hpp>
#include <asio/redirect_error.hpp>

#include "common/net/until_first_ends.h"
#include "common/work/engine.h"

namespace rayfarm {
namespace {

std::string number_of(JobId job) { return std::to_string(static_cast<std::uint64_t>(job)); }

void log_start(const FrameStart& start) {
  const RenderSettings& s = start.settings;
  spdlog::info("job {} starts, frame {}: {}x{}, {} samples per pixel, scene {}", number_of(start.job),
               s.frame, s.width, s.height, s.spp, start.scene_hash.substr(0, 8));
}

Hello hello_of(const WorkerIdentity& identity) {
  return {{},
          RAYFARM_VERSION,
          identity.name,
          identity.cpu,
          identity.threads,
          engine_fingerprint(),
          identity.process};
}

}  // namespace

void check(const WorkerIdentity& identity) {
  if (identity.name.empty())
    throw std::invalid_argument("the worker's name must not be empty: give one with --name");
  try {
    encode(ToMaster{hello_of(identity)});
  } catch (const CodecError& error) {
    throw std::invalid_argument("the worker's name \"" + identity.name +
                                "\" cannot be used: " + error.what());
  }
}

WorkerSession::WorkerSession(Channel channel, WorkerIdentity identity, Crew& crew, SessionTimes times)
    : connection_(std::move(channel), times.connection),
      identity_(std::move(identity)),
      crew_(crew),
      times_(times),
      patience_(connection_.executor(), std::chrono::steady_clock::time_point::max()) {}

asio::awaitable<void> WorkerSession::run() {
  // The crew may answer when this session is over, and another one may have begun.
  crew_.begin([session = weak_from_this(), executor = connection_.executor()](ToMaster message) {
    asio::post(executor, [session, message = std::move(message)] {
      if (const auto alive = session.lock()) alive->answer(message);
    });
  });
  connection_.post(hello_of(identity_));
  return until_first_ends(connection_.tend(), converse(), wait_for_end_of_patience());
}

asio::awaitable<void> WorkerSession::converse() {
  connection_.expect_message_within(times_.connection.handshake);
  for (;;) {
    const ToWorker message = co_await connection_.receive();
    if (const auto* goodbye = std::get_if<Goodbye>(&message)) {
      spdlog::info("the master at {} said goodbye: {}", peer(), goodbye->reason);
      co_return;
    }
    handle(message);
  }
}

void WorkerSession::handle(const ToWorker& message) {
  if (const auto* refused = std::get_if<Refused>(&message))
    throw ConnectionLost("it refused us: " + refused->reason);
  if (const auto* welcome = std::get_if<Welcome>(&message)) {
    if (!common_versions(welcome->versions, {}))
      throw CodecError("the master chose a protocol that we do not speak");
    welcomed_ = true;
    spdlog::info("connected to the master at {}, as \"{}\", {}", peer(), welcome->name,
                 connection_.channel().is_encrypted() ? "encrypted" : "plaintext");
    offer_kept(welcome->versions);
  } else if (!welcomed_) {
    throw CodecError("the master gave work before it said welcome");
  } else if (const auto* assignment = std::get_if<Assignment>(&message)) {
    held_.insert(assignment->lease);
    crew_.take(*assignment);
  } else if (const auto* piece = std::get_if<PieceAssignment>(&message)) {
    held_.insert(piece->work.lease);
    crew_.take(*piece);
  } else if (const auto* revoke = std::get_if<Revoke>(&message)) {
    for (const LeaseId lease : revoke->leases) held_.erase(lease);
    crew_.take(*revoke);
    leave_when_done();
  } else if (const auto* start = std::get_if<FrameStart>(&message)) {
    log_start(*start);
    crew_.take(*start);
  } else if (const auto* end = std::get_if<FrameEnd>(&message)) {
    spdlog::info("job {} ended, frame {}", number_of(end->job), end->frame);
    crew_.take(*end);
  } else if (const auto* scene = std::get_if<SceneData>(&message)) {
    crew_.take(*scene);
  } else if (const auto* asset = std::get_if<AssetData>(&message)) {
    crew_.take(*asset);
  } else if (const auto* dropped = std::get_if<AssetEnd>(&message)) {
    crew_.take(*dropped);
  } else if (const auto* unneeded = std::get_if<Unneeded>(&message)) {
    crew_.take(*unneeded);
  }
}

void WorkerSession::offer_kept(const Versions& spoken) {
  if (!(spoken.capabilities & can_reattach)) return crew_.forget_kept();
  std::vector<HeldTile> kept = crew_.kept();
  if (kept.empty()) return;
  const auto finished = std::ranges::count(kept, true, &HeldTile::is_finished);
  spdlog::info("{} tiles are still here, {} of them finished", kept.size(), finished);
  connection_.post(Holds{std::move(kept)});
}

void WorkerSession::answer(const ToMaster& message) {
  if (const auto* result = std::get_if<Result>(&message)) held_.erase(result->lease);
  if (const auto* piece = std::get_if<PieceResult>(&message)) held_.erase(piece->result.lease);
  if (const auto* given = std::get_if<GiveBack>(&message)) {
    for (const LeaseId lease : given->leases) held_.erase(lease);
    if (!given->reason.empty()) spdlog::warn("gave a tile back: {}", given->reason);
  }
  connection_.post(message);
  leave_when_done();
}

// A clean stop. --------------------------------------------------------------------------------------------

void WorkerSession::stop() {
  if (stopping_) return;
  stopping_ = true;
  const std::vector<LeaseId> not_begun = crew_.stop_taking();
  for (const LeaseId lease : not_begun) held_.erase(lease);
  spdlog::info("stopping: {} tiles go back, {} are finished first", not_begun.size(), held_.size());
  connection_.post(GiveBack{not_begun, ""});
  patience_.expires_after(times_.to_finish);
  leave_when_done();
}

void WorkerSession::leave_when_done() {
  if (stopping_ && held_.empty()) leave();
}

void WorkerSession::leave() {
  connection_.post(Goodbye{"the worker stops"});
  connection_.finish();
}

asio::awaitable<void> WorkerSession::wait_for_end_of_patience() {
  while (std::chrono::steady_clock::now() < patience_.expiry()) {
    asio::error_code expiry_changed;
    co_await patience_.async_wait(asio::redirect_error(asio::use_awaitable, expiry_changed));
  }
  const std::vector<LeaseId> unfinished = crew_.abandon();
  spdlog::warn("{} tiles were not finished in time and go back", unfinished.size());
  connection_.post(GiveBack{unfinished, ""});
  leave();
  co_await connection_.wait_for_end();
}

}  // namespace rayfarm
