#include "tests/support/live_viewer.h"

#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <filesystem>
#include <fstream>

namespace rayfarm {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;

struct LiveViewer::Parts {
  asio::io_context io;
  websocket::stream<tcp::socket> socket{io};
};

LiveViewer::LiveViewer(std::uint16_t port, const std::map<std::string, std::string>& header)
    : parts_(std::make_unique<Parts>()) {
  parts_->socket.next_layer().connect({asio::ip::address_v4::loopback(), port});
  const std::string host = "127.0.0.1:" + std::to_string(port);
  parts_->socket.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    for (const auto& [name, value] : header) request.set(name, value);
  }));
  websocket::response_type response;
  boost::system::error_code refused;
  parts_->socket.handshake(response, host, "/api/v1/live", refused);
  if (refused)
    throw ViewerEnded(std::to_string(response.result_int()) + " " + std::string(response.reason()));
  parts_->socket.read_message_max(0);
}

LiveViewer::~LiveViewer() = default;

void LiveViewer::say(const std::string& text) {
  boost::system::error_code gone;  // next() will tell
  parts_->socket.write(asio::buffer(text), gone);
}

LiveViewer::Message LiveViewer::next() {
  beast::flat_buffer buffer;
  boost::system::error_code ended;
  parts_->socket.read(buffer, ended);
  if (ended) throw ViewerEnded(std::string(parts_->socket.reason().reason.c_str()));
  const auto* bytes = static_cast<const std::uint8_t*>(buffer.data().data());
  return {parts_->socket.got_text(), {bytes, bytes + buffer.size()}};
}

std::size_t open_descriptors() {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}));
}

std::uint64_t resident_memory() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace rayfarm
