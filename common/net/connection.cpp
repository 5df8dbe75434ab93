#include "common/net/connection.h"

#include <algorithm>
#include <asio/buffer.hpp>
#include <asio/post.hpp>
#include <asio/redirect_error.hpp>
#include <cstring>

#include "common/net/until_first_ends.h"

namespace rayfarm {
namespace {

// Bytes; twice the results of all the leases that a worker can hold.
constexpr std::size_t queue_limit = 128u << 20;
constexpr std::size_t batch_size = 1u << 20;    // bytes written at once
constexpr std::size_t buffer_size = 64u << 10;  // grows for larger frames, as their bytes come
constexpr std::size_t least_rate = 64u << 10;   // bytes per second that a large frame must make

std::string seconds(std::chrono::milliseconds time) {
  std::string text = std::to_string(std::chrono::duration<double>(time).count());
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

/// Small frames go out together, but not so many that what has long arrived counts as queued.
std::vector<Frame> take_batch(std::deque<Frame>& queue) {
  std::vector<Frame> batch;
  for (std::size_t bytes = 0; !queue.empty() && bytes < batch_size; queue.pop_front()) {
    bytes += queue.front().head.size();
    batch.push_back(std::move(queue.front()));
  }
  return batch;
}

std::vector<asio::const_buffer> buffers_of(const std::vector<Frame>& frames) {
  std::vector<asio::const_buffer> buffers;
  for (const Frame& frame : frames) {
    buffers.push_back(asio::buffer(frame.head));
    if (frame.tail) buffers.push_back(asio::buffer(*frame.tail));
  }
  return buffers;
}

template <class In>
FrameHeader decode_header(ByteView bytes) {
  const auto header = bytes.first<frame_header_size>();
  if constexpr (std::is_same_v<In, ToWorker>)
    return decode_frame_header_to_worker(header);
  else
    return decode_frame_header_to_master(header);
}

template <class In>
In decode_message(const FrameHeader& header, ByteView payload) {
  if constexpr (std::is_same_v<In, ToWorker>)
    return decode_to_worker(header, payload);
  else
    return decode_to_master(header, payload);
}

}  // namespace

template <class In, class Out>
Connection<In, Out>::Connection(Channel channel, ConnectionTimes times)
    : channel_(std::move(channel)),
      times_(times),
      peer_(channel_.address()),
      queue_changed_(channel_.executor(), Clock::time_point::max()),
      said_(Clock::now()),
      heard_(said_),
      next_event_(channel_.executor()) {}

// Ends. ----------------------------------------------------------------------------------------------------

template <class In, class Out>
void Connection<In, Out>::finish() {
  finishing_ = true;
  queue_changed_.cancel();
}

template <class In, class Out>
void Connection<In, Out>::close(std::string reason) {
  if (!ended_) ended_ = std::move(reason);
  next_event_.cancel();
}

template <class In, class Out>
asio::awaitable<void> Connection<In, Out>::tend() {
  return until_first_ends(write(), watch());
}

template <class In, class Out>
asio::awaitable<void> Connection<In, Out>::wait_for_end() {
  asio::steady_timer never(channel_.executor(), Clock::time_point::max());
  co_await never.async_wait(asio::use_awaitable);
}

// Outgoing. ------------------------------------------------------------------------------------------------

template <class In, class Out>
void Connection<In, Out>::post(const Out& message) {
  if (finishing_ || ended_) return;
  try {
    Frame frame = frame_of(message);
    queued_bytes_ += frame.head.size();
    queue_.push_back(std::move(frame));
  } catch (const CodecError& error) {
    return close(std::string("it was to be sent what cannot be sent: ") + error.what());
  }
  if (queued_bytes_ > queue_limit) return close("it does not read what it is sent");
  queue_changed_.cancel();
}

template <class In, class Out>
asio::awaitable<void> Connection<In, Out>::write() try {
  for (;;) {
    while (queue_.empty()) {
      if (finishing_) co_return channel_.end_writing();
      asio::error_code woken;
      co_await queue_changed_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
    }
    const std::vector<Frame> batch = take_batch(queue_);
    const std::vector<asio::const_buffer> buffers = buffers_of(batch);
    write_due_ = due(asio::buffer_size(buffers));
    co_await channel_.write(buffers);
    write_due_.reset();
    said_ = Clock::now();
    for (const Frame& frame : batch) queued_bytes_ -= frame.head.size();
  }
} catch (const asio::system_error& error) {
  lose(error);
}

// Time. ----------------------------------------------------------------------------------------------------

template <class In, class Out>
typename Connection<In, Out>::Clock::time_point Connection<In, Out>::due(std::size_t bytes) const {
  return Clock::now() + times_.silence + std::chrono::seconds(bytes / least_rate);
}

template <class In, class Out>
void Connection<In, Out>::expect_message_within(std::chrono::milliseconds patience) {
  message_due_ = Clock::now() + patience;
}

template <class In, class Out>
void Connection<In, Out>::check_deadlines(Clock::time_point now) const {
  if (ended_) throw ConnectionLost(*ended_);
  if (now >= heard_ + times_.silence) throw PeerSilent("it was silent for " + seconds(times_.silence));
  if (frame_due_ && now >= *frame_due_) throw ConnectionLost("it sent half a message and no more in time");
  if (message_due_ && now >= *message_due_) throw ConnectionLost("it did not say what was expected in time");
  if (write_due_ && now >= *write_due_) throw ConnectionLost("it does not read what it is sent");
}

template <class In, class Out>
void Connection<In, Out>::beat(Clock::time_point now) {
  if (write_due_ || !queue_.empty() || now < said_ + times_.heartbeat) return;
  post(Heartbeat{});
}

template <class In, class Out>
typename Connection<In, Out>::Clock::time_point Connection<In, Out>::next_event() const {
  // A deadline set meanwhile is seen at the next heartbeat.
  Clock::time_point next = std::min(Clock::now() + times_.heartbeat, heard_ + times_.silence);
  if (!write_due_ && queue_.empty()) next = std::min(next, said_ + times_.heartbeat);
  for (const Deadline& deadline : {frame_due_, message_due_, write_due_})
    if (deadline) next = std::min(next, *deadline);
  return next;
}

template <class In, class Out>
asio::awaitable<void> Connection<In, Out>::watch() {
  for (;;) {
    next_event_.expires_at(next_event());
    asio::error_code woken;
    co_await next_event_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
    // Bytes that came while this thread was busy elsewhere count: the reader sees them first.
    co_await asio::post(channel_.executor(), asio::use_awaitable);
    const Clock::time_point now = Clock::now();
    check_deadlines(now);
    beat(now);
  }
}

// Incoming. ------------------------------------------------------------------------------------------------

template <class In, class Out>
void Connection<In, Out>::make_room(std::size_t size) {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == 0 && buffer_.size() > buffer_size) buffer_ = Bytes();  // a scene has passed
  if (end_ == buffer_.size()) buffer_.resize(std::max(buffer_size, std::min(2 * end_, size)));
}

/// Reads until `size` bytes are there.
template <class In, class Out>
asio::awaitable<void> Connection<In, Out>::fill(std::size_t size) try {
  while (end_ - begin_ < size) {
    if (end_ > begin_ && !frame_due_) frame_due_ = due(frame_header_size);
    make_room(size);
    const asio::mutable_buffer room = asio::buffer(buffer_) + end_;
    end_ += co_await channel_.read_some(room);
    heard_ = Clock::now();
  }
} catch (const asio::system_error& error) {
  lose(error);
}

template <class In, class Out>
asio::awaitable<In> Connection<In, Out>::receive() {
  for (;;) {
    co_await fill(frame_header_size);
    const FrameHeader header = decode_header<In>(ByteView(buffer_).subspan(begin_, frame_header_size));
    if (header.size > largest_)
      throw CodecError("a message of " + std::to_string(header.size) + " bytes comes too early");
    if (end_ - begin_ < frame_header_size + header.size) frame_due_ = due(header.size);
    co_await fill(frame_header_size + header.size);
    In message =
        decode_message<In>(header, ByteView(buffer_).subspan(begin_ + frame_header_size, header.size));
    begin_ += frame_header_size + header.size;
    frame_due_.reset();
    if (std::holds_alternative<Heartbeat>(message)) continue;
    message_due_.reset();
    co_return message;
  }
}

template class Connection<ToMaster, ToWorker>;
template class Connection<ToWorker, ToMaster>;

}  // namespace rayfarm
