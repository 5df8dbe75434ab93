#include "common/net/connection.h"

#include <gtest/gtest.h>

#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/io_context.hpp>
#include <asio/read.hpp>
#include <asio/write.hpp>

#include "common/net/dial.h"
#include "common/net/run_until_end.h"
#include "common/net/until_first_ends.h"
#include "tests/common/net/random_messages.h"

namespace rayfarm {
namespace {

using asio::ip::tcp;
using namespace std::chrono_literals;

constexpr ConnectionTimes quick{10ms, 60ms, 60ms};
constexpr ConnectionTimes patient{10ms, 60s, 60s};

/// A connected pair of sockets on loopback.
struct Sockets {
  asio::io_context io;
  tcp::socket ours{io}, theirs{io};

  Sockets() {
    tcp::acceptor acceptor(io, {asio::ip::address_v4::loopback(), 0});
    theirs.connect(acceptor.local_endpoint());
    acceptor.accept(ours);
  }

  /// Runs a coroutine to its end; what it threw is the answer, else "".
  std::string run(asio::awaitable<void> loop) {
    try {
      run_until_end(io, std::move(loop));
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
};

/// Receives until the connection ends.
template <class C, class M>
asio::awaitable<void> receive_all(C& connection, std::vector<M>& messages) {
  for (;;) messages.push_back(co_await connection.receive());
}
template <class C, class M>
asio::awaitable<void> receive_some(C& connection, std::vector<M>& messages, std::size_t count) {
  while (messages.size() < count) messages.push_back(co_await connection.receive());
}

/// How the master's end finds this peer, who sends these bytes and then nothing.
std::string verdict_on(const Bytes& bytes, ConnectionTimes times) {
  Sockets s;
  asio::write(s.theirs, asio::buffer(bytes));
  WorkerConnection connection(std::move(s.ours), times);
  std::vector<ToMaster> messages;
  return s.run(until_first_ends(connection.tend(), receive_all(connection, messages)));
}

TEST(Connection, DeliversAllMessagesInOrder) {
  std::mt19937_64 random(1);
  std::vector<ToMaster> sent, received;
  for (int round = 0; round < 50; ++round)
    for (const ToMaster& message : random_to_master(random))
      if (!std::holds_alternative<Heartbeat>(message)) sent.push_back(message);

  Sockets s;
  MasterConnection worker(std::move(s.theirs), patient);
  WorkerConnection master(std::move(s.ours), patient);
  for (const ToMaster& message : sent) worker.post(message);
  asio::co_spawn(s.io, worker.tend(), asio::detached);
  EXPECT_EQ(s.run(until_first_ends(master.tend(), receive_some(master, received, sent.size()))), "");
  ASSERT_EQ(received.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_EQ(encode(received[i]), encode(sent[i]));
}

TEST(Connection, CarriesAMessageMuchLargerThanItsBuffer) {
  const auto bytes = std::make_shared<const Bytes>(30'000'000, 7);
  Sockets s;
  MasterConnection worker(std::move(s.theirs), patient);
  WorkerConnection master(std::move(s.ours), patient);
  master.post(SceneData{sha256_hex(*bytes), bytes});
  master.post(FrameEnd{JobId{3}});
  asio::co_spawn(s.io, master.tend(), asio::detached);
  std::vector<ToWorker> received;
  EXPECT_EQ(s.run(until_first_ends(worker.tend(), receive_some(worker, received, 2))), "");
  EXPECT_EQ(*std::get<SceneData>(received[0]).bytes, *bytes);
  EXPECT_EQ(std::get<FrameEnd>(received[1]).job, JobId{3});
}

TEST(Connection, BeatsWhileNothingElseIsSaid) {
  Sockets s;
  WorkerConnection connection(std::move(s.ours), patient);
  const Bytes beat = encode(ToWorker{Heartbeat{}});
  Bytes heard(3 * beat.size());
  auto listen = [](tcp::socket& socket, Bytes& bytes) -> asio::awaitable<void> {
    co_await asio::async_read(socket, asio::buffer(bytes), asio::use_awaitable);
  };
  EXPECT_EQ(s.run(until_first_ends(connection.tend(), listen(s.theirs, heard))), "");
  Bytes expected = beat;
  expected.insert(expected.end(), beat.begin(), beat.end());
  expected.insert(expected.end(), beat.begin(), beat.end());
  EXPECT_EQ(heard, expected);
}

TEST(Connection, IsKeptByHeartbeatsAlone) {
  constexpr ConnectionTimes times{20ms, 400ms, 400ms};
  Sockets s;
  MasterConnection worker(std::move(s.theirs), times);
  WorkerConnection master(std::move(s.ours), times);
  std::vector<ToWorker> to_worker;
  std::vector<ToMaster> to_master;
  asio::co_spawn(s.io, until_first_ends(worker.tend(), receive_all(worker, to_worker)), asio::detached);
  // Twice the silence that would end it, then the end that we asked for.
  asio::steady_timer timer(s.io, 2 * times.silence);
  timer.async_wait([&](asio::error_code) { master.close("it was enough"); });
  EXPECT_EQ(s.run(until_first_ends(master.tend(), receive_all(master, to_master))), "it was enough");
}

TEST(Connection, EndsWithASilentPeer) { EXPECT_EQ(verdict_on({}, quick), "it was silent for 0.06 s"); }

TEST(Connection, EndsWithAPeerThatStopsInAFrame) {
  Bytes half = encode(ToMaster{Goodbye{"a long reason"}});
  half.resize(half.size() / 2);
  EXPECT_EQ(verdict_on(half, {10ms, 60ms, 60ms}), "it was silent for 0.06 s");
}

/// Sends one byte at each beat, so that it is never silent.
asio::awaitable<void> dribble(tcp::socket& socket, Bytes bytes) {
  asio::steady_timer timer(socket.get_executor());
  for (const std::uint8_t& byte : bytes) {
    timer.expires_after(20ms);
    co_await timer.async_wait(asio::use_awaitable);
    co_await socket.async_send(asio::buffer(&byte, 1), asio::use_awaitable);
  }
}

TEST(Connection, EndsWithAPeerThatDribbles) {
  Sockets s;
  WorkerConnection connection(std::move(s.ours), quick);
  std::vector<ToMaster> messages;
  asio::co_spawn(s.io, dribble(s.theirs, encode(ToMaster{Goodbye{std::string(200, 'x')}})), asio::detached);
  EXPECT_EQ(s.run(until_first_ends(connection.tend(), receive_all(connection, messages))),
            "it sent half a message and no more in time");
}

TEST(Connection, EndsWithAPeerThatBeatsButDoesNotSayWhatIsExpected) {
  Sockets s;
  MasterConnection worker(std::move(s.theirs), patient);
  WorkerConnection master(std::move(s.ours), patient);
  std::vector<ToMaster> messages;
  asio::co_spawn(s.io, worker.tend(), asio::detached);
  master.expect_message_within(40ms);
  EXPECT_EQ(s.run(until_first_ends(master.tend(), receive_all(master, messages))),
            "it did not say what was expected in time");
}

TEST(Connection, EndsWithGarbageAHugeLengthAndADamagedFrame) {
  EXPECT_EQ(verdict_on(Bytes(100, 'G'), patient), "the peer does not speak rayfarm's protocol");
  Bytes huge = encode(ToMaster{Heartbeat{}});
  huge[11] = 0x7f;
  EXPECT_EQ(verdict_on(huge, patient), "a message of type 3 announces 2130706433 bytes, the limit is 8192");
  Bytes damaged = encode(ToMaster{Goodbye{"reason"}});
  damaged.back() ^= 1;
  EXPECT_EQ(verdict_on(damaged, patient), "a message of type 4 was damaged on its way");
}

TEST(Connection, EndsWhenThePeerCloses) {
  Sockets s;
  WorkerConnection connection(std::move(s.ours), patient);
  s.theirs.close();
  std::vector<ToMaster> messages;
  EXPECT_EQ(s.run(until_first_ends(connection.tend(), receive_all(connection, messages))),
            "the other side closed the connection");
}

TEST(Connection, CutsOffAPeerThatDoesNotRead) {
  std::mt19937_64 random(2);
  Sockets s;
  MasterConnection connection(std::move(s.ours), patient);
  const ToMaster result = random_to_master(random)[1];
  for (int i = 0; i < 5'000; ++i) connection.post(result);
  EXPECT_EQ(s.run(connection.tend()), "it does not read what it is sent");
}

TEST(Connection, CutsOffAPeerThatReadsTooSlowly) {
  Sockets s;
  WorkerConnection connection(std::move(s.ours), quick);
  const auto bytes = std::make_shared<const Bytes>(
      20'000'000, 7);  // more than the kernel's buffers, 305 s at the least rate
  connection.post(SceneData{sha256_hex(*bytes), bytes});
  EXPECT_EQ(s.run(connection.tend()), "it was silent for 0.06 s");
}

TEST(Connection, SendsAllThatWasPostedBeforeItFinishes) {
  Sockets s;
  WorkerConnection connection(std::move(s.ours), patient);
  for (std::uint64_t i = 0; i < 100; ++i) connection.post(FrameEnd{JobId{i}});
  connection.post(Goodbye{"done"});
  connection.finish();
  connection.post(FrameEnd{JobId{200}});
  MasterConnection worker(std::move(s.theirs), patient);
  EXPECT_EQ(s.run(connection.tend()), "");
  s.io.restart();
  std::vector<ToWorker> messages;
  EXPECT_EQ(s.run(receive_some(worker, messages, 101)), "");
  EXPECT_EQ(std::get<Goodbye>(messages.back()).reason, "done");
}

TEST(Connection, EndsWhenAMessageCannotBeSent) {
  Sockets s;
  WorkerConnection connection(std::move(s.ours), patient);
  connection.post(Goodbye{"\a"});
  EXPECT_EQ(
      s.run(connection.tend()),
      "it was to be sent what cannot be sent: a text is not one line of UTF-8 without control characters");
}

asio::awaitable<void> try_to_dial(Address address, Security security) {
  co_await dial(address, security, 10s);
}

template <class Error>
void expect_dial_fails(const Address& address, const Security& security) {
  asio::io_context io;
  EXPECT_THROW(run_until_end(io, try_to_dial(address, security)), Error);
}

TEST(Dial, SaysWhatIsWrongWithTheAddress) {
  expect_dial_fails<AddressError>({"no.such.host.invalid", 5411}, {Exposure::insecure});
  expect_dial_fails<ConnectionLost>({"127.0.0.1", 1}, {Exposure::loopback_only});
}

TEST(Exposure, OfThePlaintextFarmNeedsPermission) {
  expect_dial_fails<ExposureError>({"192.0.2.1", 5411}, {Exposure::loopback_only});
  asio::io_context io;
  EXPECT_THROW(listen_at(io, {"0.0.0.0", 0}, {Exposure::loopback_only}), ExposureError);
  EXPECT_NO_THROW(listen_at(io, {"0.0.0.0", 0}, {Exposure::insecure}));
  EXPECT_NO_THROW(listen_at(io, {"localhost", 0}, {Exposure::loopback_only}));
  EXPECT_THROW(listen_at(io, {"192.0.2.1", 0}, {Exposure::insecure}), AddressError);  // not ours
}

}  // namespace
}  // namespace rayfarm
