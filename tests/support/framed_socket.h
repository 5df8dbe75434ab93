// One end of the conversation, spoken by hand: a test says what it wants when it wants, and waits for what
// comes.
#pragma once
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/read.hpp>
#include <asio/write.hpp>

#include "common/net/address.h"
#include "common/net/codec.h"

namespace rayfarm {

template <class In, class Out>
class FramedSocket {
 public:
  using tcp = asio::ip::tcp;

  void connect(const Address& address) {
    socket_.connect({asio::ip::make_address(address.host), address.port});
  }
  void accept(tcp::acceptor& acceptor) { socket_ = acceptor.accept(); }

  void send(const Out& message) { send_bytes(encode(message)); }
  void send_bytes(const Bytes& bytes) { asio::write(socket_, asio::buffer(bytes)); }
  void close() { socket_.close(); }

  /// The next message other than Heartbeat. Throws asio::system_error when the other side ends the
  /// connection.
  In receive() {
    for (;;) {
      std::array<std::uint8_t, frame_header_size> bytes;
      asio::read(socket_, asio::buffer(bytes));
      const FrameHeader header = decode_header(bytes);
      Bytes payload(header.size);
      asio::read(socket_, asio::buffer(payload));
      In message = decode(header, payload);
      if (!std::holds_alternative<Heartbeat>(message)) return message;
    }
  }
  template <class Message>
  Message receive_a() {
    return std::get<Message>(receive());
  }
  /// Waits until the other side ends the connection, whatever it says before.
  void wait_for_end() {
    std::array<std::uint8_t, 4096> bytes;
    asio::error_code error;
    while (!error) socket_.read_some(asio::buffer(bytes), error);
  }

 private:
  static FrameHeader decode_header(std::span<const std::uint8_t, frame_header_size> bytes) {
    if constexpr (std::is_same_v<In, ToWorker>)
      return decode_frame_header_to_worker(bytes);
    else
      return decode_frame_header_to_master(bytes);
  }
  static In decode(const FrameHeader& header, ByteView payload) {
    if constexpr (std::is_same_v<In, ToWorker>)
      return decode_to_worker(header, payload);
    else
      return decode_to_master(header, payload);
  }

  asio::io_context io_;
  tcp::socket socket_{io_};
};

using WorkerByHand = FramedSocket<ToWorker, ToMaster>;
using MasterByHand = FramedSocket<ToMaster, ToWorker>;

}  // namespace rayfarm
