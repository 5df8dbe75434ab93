// Messages over a channel: framed, bounded in time and memory, with heartbeats both ways.
//
// A session is a coroutine with a Connection as local variable, and two loops that run until the first ends:
//   until_first_ends(connection.tend(), converse(connection));
// All calls are made from the thread that runs the channel's io_context.
#pragma once
#include <asio/awaitable.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>

#include "common/net/channel.h"
#include "common/net/codec.h"

namespace rayfarm {

/// Tests make them shorter.
struct ConnectionTimes {
  std::chrono::milliseconds heartbeat = heartbeat_interval;
  std::chrono::milliseconds silence = peer_patience;
  std::chrono::milliseconds handshake = handshake_patience;
};

template <class In, class Out>
class Connection {
 public:
  Connection(Channel channel, ConnectionTimes times);
  Connection(const Connection&) = delete;

  /// Puts a message in the queue and returns at once. What cannot be sent, because the peer does not read or
  /// the message breaks a limit, ends the connection.
  void post(const Out& message);
  /// Ends tend() once all that was posted has been sent; what is posted later is dropped.
  void finish();
  /// Ends tend() now, with ConnectionLost and this reason.
  void close(std::string reason);

  /// Sends what was posted and heartbeats, and watches the peer. Returns after finish(); throws
  /// PeerSilent, or ConnectionLost when the peer is slow or the connection breaks.
  asio::awaitable<void> tend();
  /// The next message other than Heartbeat. Throws ConnectionLost, or CodecError on what cannot be a message.
  asio::awaitable<In> receive();
  /// For the other loop, when it has nothing more to do than to let tend() end.
  asio::awaitable<void> wait_for_end();
  /// The next message must come within this time, or tend() throws.
  void expect_message_within(std::chrono::milliseconds patience);
  /// Until it is called again: receive() throws CodecError when a larger message begins. At first any size is good that
  /// its kind may have.
  void take_messages_up_to(std::uint32_t bytes) { largest_ = bytes; }

  asio::any_io_executor executor() { return channel_.executor(); }
  const Channel& channel() const { return channel_; }
  /// The other end, as ADDRESS:PORT.
  const std::string& peer() const { return peer_; }

 private:
  using Clock = std::chrono::steady_clock;
  using Deadline = std::optional<Clock::time_point>;

  asio::awaitable<void> write();
  asio::awaitable<void> watch();
  asio::awaitable<void> fill(std::size_t size);
  void make_room(std::size_t size);
  void check_deadlines(Clock::time_point now) const;
  void beat(Clock::time_point now);
  Clock::time_point next_event() const;
  /// How long `bytes` may take.
  Clock::time_point due(std::size_t bytes) const;

  Channel channel_;
  ConnectionTimes times_;
  std::string peer_;
  std::optional<std::string> ended_;

  // Outgoing.
  std::deque<Frame> queue_;
  std::size_t queued_bytes_ = 0;  // of frame heads, those being written included: tails are shared
  bool finishing_ = false;
  asio::steady_timer queue_changed_;  // never expires: cancelled when the queue has changed
  Deadline write_due_;                // while something is being written
  Clock::time_point said_;

  // Incoming. Bytes begin_ to end_ of the buffer have come and wait to be decoded.
  Bytes buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::uint32_t largest_ = std::numeric_limits<std::uint32_t>::max();
  Deadline frame_due_;    // while a frame has come in part
  Deadline message_due_;  // expect_message_within()
  Clock::time_point heard_;
  asio::steady_timer next_event_;
};

/// The master's end.
using WorkerConnection = Connection<ToMaster, ToWorker>;
/// The worker's end.
using MasterConnection = Connection<ToWorker, ToMaster>;

}  // namespace rayfarm
