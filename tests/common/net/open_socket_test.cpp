#include "common/net/open_socket.h"

#include <gtest/gtest.h>

#include <array>
#include <asio/buffer.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>

namespace rayfarm {
namespace {

using asio::ip::tcp;

TEST(OpenSocket, EndsItsConnectionAndNotTheNextOfTheSameNumber) {
  asio::io_context io;
  tcp::acceptor door(io, {asio::ip::address_v4::loopback(), 0});
  tcp::socket first(io), second(io);
  first.connect(door.local_endpoint()), second.connect(door.local_endpoint());
  tcp::socket accepted = door.accept();
  const int number = accepted.native_handle();
  const OpenSocket old(number);
  accepted.close();
  old.shut_down();
  accepted = door.accept();
  ASSERT_EQ(accepted.native_handle(), number);

  old.shut_down();
  second.non_blocking(true);
  std::array<char, 1> byte;
  asio::error_code error;
  second.read_some(asio::buffer(byte), error);
  EXPECT_EQ(error, asio::error::would_block);
  OpenSocket(number).shut_down();
  second.non_blocking(false);
  second.read_some(asio::buffer(byte), error);
  EXPECT_EQ(error, asio::error::eof);
}

}  // namespace
}  // namespace rayfarm
