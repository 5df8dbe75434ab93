// Channels between two ends on loopback: what a side is, its certificate says.
#include "common/net/channel.h"

#include <gtest/gtest.h>

#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/write.hpp>
#include <random>

#include "common/net/connection.h"
#include "common/net/run_until_end.h"
#include "common/net/until_first_ends.h"
#include "tests/common/net/random_messages.h"
#include "tests/support/farm_keys.h"

namespace rayfarm {
namespace {

using asio::ip::tcp;
using namespace std::chrono_literals;

constexpr ConnectionTimes patient{10ms, 60s, 60s};

const FarmKeys& farm() {
  static const FarmKeys made;
  return made;
}

/// Both ends of a conversation on loopback, one dialled, one accepted.
struct Ends {
  asio::io_context io;
  tcp::acceptor door{io, {asio::ip::address_v4::loopback(), 0}};
  std::optional<Channel> dialled, accepted;
  std::string dialled_fault, accepted_fault;  // why there is none

  Ends(Security dialling, Security accepting) {
    int ended = 0;
    const auto count = [&ended](std::exception_ptr) { ++ended; };
    asio::co_spawn(io, call(std::move(dialling)), count);
    asio::co_spawn(io, open(std::move(accepting)), count);
    while (ended < 2) io.run_one();
  }
  asio::awaitable<void> call(Security security) try {
    auto dialling = dial({"127.0.0.1", door.local_endpoint().port()}, security, 10s);
    dialled = co_await std::move(dialling);
    if (dialled->is_encrypted()) co_return;
    const std::vector<asio::const_buffer> greeting{asio::buffer("R", 1)};
    co_await dialled->write(greeting);
  } catch (const std::exception& error) {
    dialled_fault = error.what();
    door.cancel();  // nobody comes
  }
  asio::awaitable<void> open(Security security) try {
    tcp::socket socket = co_await accept(door);
    auto greeting = greet(std::move(socket), security, 10s);
    accepted = co_await std::move(greeting);
  } catch (const std::exception& error) {
    accepted_fault = error.what();
  }

  /// Runs a coroutine to its end; what it threw is the answer, else "".
  std::string run(asio::awaitable<void> loop) {
    io.restart();
    try {
      run_until_end(io, std::move(loop));
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
};

TEST(Channel, IsEncryptedBetweenAMasterAndItsWorkerWhoeverDialled) {
  const Security master = farm().of_master(), worker = farm().of_worker("lab7");
  Ends to_master(worker, master);
  ASSERT_TRUE(to_master.dialled && to_master.accepted) << to_master.dialled_fault << to_master.accepted_fault;
  EXPECT_TRUE(to_master.accepted->is_encrypted());
  EXPECT_EQ(to_master.accepted->peer()->facts.name, "lab7");
  EXPECT_EQ(to_master.dialled->peer()->facts.name, "the master");

  Ends to_worker(master, worker);
  ASSERT_TRUE(to_worker.dialled && to_worker.accepted) << to_worker.dialled_fault << to_worker.accepted_fault;
  EXPECT_EQ(to_worker.accepted->peer()->facts.role, PeerRole::master);
  EXPECT_EQ(to_worker.dialled->peer()->facts.name, "lab7");
}

TEST(Channel, IsPlaintextOnLoopbackUnlessItIsClosed) {
  Security master = farm().of_master();
  master.exposure = Exposure::loopback_only;
  const Security unpaired;
  Ends ends(unpaired, master);
  ASSERT_TRUE(ends.dialled && ends.accepted) << ends.dialled_fault << ends.accepted_fault;
  EXPECT_FALSE(ends.accepted->is_encrypted());

  EXPECT_EQ(Ends(unpaired, farm().of_master()).accepted_fault, "it does not encrypt what it says");
  EXPECT_NE(Ends({Exposure::closed}, master).dialled_fault.find("rayfarm-worker join"), std::string::npos);
}

TEST(Channel, IsRefusedToACertificateOfAnotherFarmOrThatHasExpired) {
  const FarmKeys other;
  EXPECT_EQ(Ends(other.of_worker("spy"), farm().of_master()).accepted_fault,
            "the certificate of \"spy\" is refused: it is of another farm");
  EXPECT_EQ(Ends(farm().of_worker("lab7"), other.of_master()).dialled_fault,
            "the certificate of \"the master\" is refused: it is of another farm");
  const Identity old = farm().identity(PeerRole::worker, "lab7", {farm().now - 48h, farm().now - 1h});
  EXPECT_EQ(Ends(farm().of_worker(old), farm().of_master()).accepted_fault,
            "the certificate of \"lab7\" is refused: it has expired");
  const Identity early = farm().identity(PeerRole::worker, "lab7", {farm().now + 48h, farm().now + 50h});
  EXPECT_EQ(Ends(farm().of_worker(early), farm().of_master()).accepted_fault,
            "the certificate of \"lab7\" is refused: it is not valid yet: is this PC's clock right?");
}

TEST(Channel, OfOneThatIsRefusedLeavesNoWordsOfItsOwnInALog) {
  const FarmKeys other;
  for (const std::string& name : {std::string("lab\n[info] lab7 was paired"), std::string("\x1b[2J")})
    EXPECT_EQ(Ends(other.of_worker(name), farm().of_master()).accepted_fault,
              "the certificate of no name is refused: it is of another farm");
}

TEST(Channel, IsRefusedToAWorkerThatPassesForTheMaster) {
  const Security spy = farm().of_master(farm().identity(PeerRole::worker, "spy"));
  EXPECT_EQ(Ends(farm().of_worker("lab7"), spy).dialled_fault,
            "the certificate of \"spy\" is refused: it is a worker's");
}

TEST(Channel, OfAStrangerIsEncryptedButNamesNobody) {
  Ends ends({Exposure::closed, TlsContext::of_stranger()}, farm().of_master());
  ASSERT_TRUE(ends.accepted) << ends.accepted_fault;
  EXPECT_TRUE(ends.accepted->is_encrypted());
  EXPECT_FALSE(ends.accepted->peer());
}

/// A stranger's end of a connection with a master.
std::optional<Channel> call_as_stranger(Ends& ends, const Security& master) {
  std::optional<Channel> channel;
  const Address address{"127.0.0.1", ends.door.local_endpoint().port()};
  const auto call = [](std::optional<Channel>& made, Address at) -> asio::awaitable<void> {
    auto dialling = dial_encrypted(at, TlsContext::of_stranger(), 10s);
    made = co_await std::move(dialling);
  };
  asio::co_spawn(ends.io, ends.open(master), asio::detached);
  EXPECT_EQ(ends.run(call(channel, address)), "");
  return channel;
}

TEST(Channel, ShowsAStrangerTheAuthorityWhoseFingerprintItKnows) {
  const std::string fingerprint = fingerprint_of(farm().authority.certificate);
  Ends ends({}, farm().of_master());  // ends at once: it does not encrypt
  const std::optional<Channel> channel = call_as_stranger(ends, farm().of_master());
  EXPECT_EQ(channel->authority_behind(fingerprint), farm().authority.certificate);
  EXPECT_EQ(channel->authority_behind(fingerprint.substr(0, 24)), farm().authority.certificate);
  EXPECT_THROW(channel->authority_behind(std::string(24, '0')), CertificateError);

  const FarmKeys other;  // shows a chain that ends in our authority, without its signature
  const Identity own = other.identity(PeerRole::master, "the master");
  const Security spy{Exposure::closed, TlsContext(own, farm().authority.certificate, PeerRole::worker)};
  EXPECT_THROW(call_as_stranger(ends, spy)->authority_behind(fingerprint), CertificateError);
  const Security worker = farm().of_master(farm().identity(PeerRole::worker, "spy"));
  EXPECT_THROW(call_as_stranger(ends, worker)->authority_behind(fingerprint), CertificateError);
}

template <class C, class M>
asio::awaitable<void> receive_some(C& connection, std::vector<M>& messages, std::size_t count) {
  while (messages.size() < count) messages.push_back(co_await connection.receive());
}

TEST(Channel, CarriesAllMessagesInOrderBothWaysAtOnce) {
  std::mt19937_64 random(1);
  std::vector<ToMaster> to_master, at_master;
  std::vector<ToWorker> to_worker, at_worker;
  for (int round = 0; round < 30; ++round) {
    for (ToMaster& message : random_to_master(random))
      if (!std::holds_alternative<Heartbeat>(message)) to_master.push_back(std::move(message));
    for (ToWorker& message : random_to_worker(random))
      if (!std::holds_alternative<Heartbeat>(message)) to_worker.push_back(std::move(message));
  }
  Ends ends(farm().of_worker("lab7"), farm().of_master());
  MasterConnection worker(std::move(*ends.dialled), patient);
  WorkerConnection master(std::move(*ends.accepted), patient);
  for (const ToMaster& message : to_master) worker.post(message);
  for (const ToWorker& message : to_worker) master.post(message);
  int received = 0;
  const auto count = [&](const std::exception_ptr& failure) {
    if (failure) std::rethrow_exception(failure);
    ++received;
  };
  asio::co_spawn(ends.io, worker.tend(), count);
  asio::co_spawn(ends.io, master.tend(), count);
  asio::co_spawn(ends.io, receive_some(worker, at_worker, to_worker.size()), count);
  asio::co_spawn(ends.io, receive_some(master, at_master, to_master.size()), count);
  ends.io.restart();
  while (received < 2) ends.io.run_one();
  for (std::size_t i = 0; i < to_master.size(); ++i) EXPECT_EQ(encode(at_master[i]), encode(to_master[i]));
  for (std::size_t i = 0; i < to_worker.size(); ++i) EXPECT_EQ(encode(at_worker[i]), encode(to_worker[i]));
}

TEST(Channel, CarriesAMessageMuchLargerThanItsRecords) {
  const auto bytes = std::make_shared<const Bytes>(30'000'000, 7);
  Ends ends(farm().of_worker("lab7"), farm().of_master());
  MasterConnection worker(std::move(*ends.dialled), patient);
  WorkerConnection master(std::move(*ends.accepted), patient);
  master.post(SceneData{sha256_hex(*bytes), bytes});
  asio::co_spawn(ends.io, master.tend(), asio::detached);
  std::vector<ToWorker> received;
  EXPECT_EQ(ends.run(until_first_ends(worker.tend(), receive_some(worker, received, 1))), "");
  EXPECT_EQ(*std::get<SceneData>(received[0]).bytes, *bytes);
}

TEST(Channel, EndsCleanlyAndWhenTheOtherSideDies) {
  for (const bool cleanly : {true, false}) {
    Ends ends(farm().of_worker("lab7"), farm().of_master());
    auto worker = std::make_unique<MasterConnection>(std::move(*ends.dialled), patient);
    WorkerConnection master(std::move(*ends.accepted), patient);
    if (cleanly) {
      worker->finish();
      EXPECT_EQ(ends.run(worker->tend()), "");
    }
    worker.reset();
    std::vector<ToMaster> none;
    EXPECT_EQ(ends.run(until_first_ends(master.tend(), receive_some(master, none, 1))),
              "the other side closed the connection");
  }
}

TEST(Channel, GivesUpAPeerThatIsSilentInTheHandshake) {
  for (const std::string& begun : {std::string(), std::string("\x16\x03\x01\x02", 4)}) {
    asio::io_context io;
    tcp::acceptor door(io, {asio::ip::address_v4::loopback(), 0});
    tcp::socket peer(io);
    peer.connect(door.local_endpoint());
    asio::write(peer, asio::buffer(begun));
    const auto take = [&]() -> asio::awaitable<void> {
      tcp::socket socket = co_await accept(door);
      auto greeting = greet(std::move(socket), farm().of_master(), 30ms);
      co_await std::move(greeting);
    };
    EXPECT_THROW(run_until_end(io, take()), ConnectionLost);
  }
}

TEST(Channel, EndsWithGarbageInsteadOfAHandshake) {
  asio::io_context io;
  tcp::acceptor door(io, {asio::ip::address_v4::loopback(), 0});
  tcp::socket peer(io);
  peer.connect(door.local_endpoint());
  asio::write(peer, asio::buffer(std::string(1000, '\x16')));
  const auto take = [&]() -> asio::awaitable<void> {
    tcp::socket socket = co_await accept(door);
    auto greeting = greet(std::move(socket), farm().of_master(), 10s);
    co_await std::move(greeting);
  };
  EXPECT_THROW(run_until_end(io, take()), ConnectionLost);
}

}  // namespace
}  // namespace rayfarm
