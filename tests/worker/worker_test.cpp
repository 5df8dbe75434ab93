#include "worker/worker.h"

#include <gtest/gtest.h>

#include <chrono>

#include "common/work/engine.h"
#include "tests/support/framed_socket.h"
#include "tests/support/simple_job.h"
#include "tests/support/worker_thread.h"

namespace rayfarm {
namespace {

using asio::ip::tcp;
using namespace std::chrono_literals;

/// Where a master listens that the test speaks for.
struct Door {
  asio::io_context io;
  tcp::acceptor acceptor{io, {asio::ip::address_v4::loopback(), 0}};

  Address address() const { return {"127.0.0.1", acceptor.local_endpoint().port()}; }
};

/// A master that has accepted a worker and heard its Hello.
struct MasterAtDoor : MasterByHand {
  Hello hello;
  explicit MasterAtDoor(Door& door) {
    accept(door.acceptor);
    hello = receive_a<Hello>();
  }
  /// As one that asks for nothing that was held.
  void welcome() { send(Welcome{hello.name, {protocol_version, protocol_version, 0}}); }
  /// Job 1 at 640x480, 80 tiles.
  void start_job() {
    const SceneData scene = scene_data(simple_scene());
    send(scene);
    send(FrameStart{JobId{1}, scene.hash, {}});
  }
  void assign(std::uint64_t lease, std::uint32_t tile) {
    send(Assignment{LeaseId{lease}, JobId{1}, 0, tile, all_passes});
  }
};

TEST(Worker, SaysHelloAndDeliversWhatItIsAssigned) {
  Door door;
  WorkerThread worker(worker_for(door.address(), "lab7"), prepare_positions);
  MasterAtDoor master(door);
  EXPECT_EQ(master.hello, (Hello{{}, RAYFARM_VERSION, "lab7", "a test's CPU", 1, engine_fingerprint()}));
  master.welcome();
  master.start_job();
  for (std::uint32_t tile = 0; tile < 20; ++tile) master.assign(100 + tile, tile);
  for (std::uint32_t tile = 0; tile < 20; ++tile) {
    const auto result = master.receive_a<Result>();
    EXPECT_EQ(result.lease, LeaseId{100 + tile});
    EXPECT_EQ(result.images, position_tile({}, tile, all_passes, [] { return false; }));
  }
}

TEST(Worker, OffersANewMasterWhatItHasOfALostOne) {
  Door door;
  WorkerThread worker(worker_for(door.address(), "lab7"), prepare_positions);
  {
    MasterAtDoor lost(door);
    lost.welcome();
    lost.start_job();
    lost.assign(100, 5);
    lost.receive_a<Result>();
  }
  MasterAtDoor next(door);
  next.send(Welcome{"lab7"});
  const Assignment held{LeaseId{100}, JobId{1}, 0, 5, all_passes};
  EXPECT_EQ(next.receive_a<Holds>(), (Holds{{{held, true}}}));
  next.start_job();
  next.assign(7, 5);
  EXPECT_EQ(next.receive_a<Result>().lease, LeaseId{7});
}

TEST(Worker, OffersNothingToAMasterThatDoesNotKnowOfIt) {
  Door door;
  WorkerThread worker(worker_for(door.address(), "lab7"), prepare_positions);
  {
    MasterAtDoor lost(door);
    lost.welcome();
    lost.start_job();
    lost.assign(100, 5);
    lost.receive_a<Result>();
  }
  MasterAtDoor older(door);
  older.welcome();
  older.start_job();
  older.assign(7, 6);
  EXPECT_EQ(older.receive_a<Result>().lease, LeaseId{7});
}

TEST(Worker, ComesBackToAMasterThatWasGone) {
  Door door;
  WorkerThread worker(worker_for(door.address(), "lab7"), prepare_positions);
  for (int time = 0; time < 3; ++time) {
    MasterAtDoor master(door);
    master.welcome();
    master.start_job();
    master.assign(1, 3);
    EXPECT_EQ(master.receive_a<Result>().tile, 3u);
  }
}

TEST(Worker, ComesBackAfterARefusalAGoodbyeAndGarbage) {
  Door door;
  WorkerThread worker(worker_for(door.address(), "lab7"), prepare_positions);
  MasterAtDoor(door).send(Refused{"not today"});
  MasterAtDoor(door).send(Goodbye{"the master stops"});
  MasterAtDoor(door).send_bytes(Bytes(1000, 'x'));
  MasterAtDoor(door).send(FrameEnd{JobId{1}});  // before Welcome
  MasterAtDoor(door).welcome();
}

// Only a lower bound of time is checked: a busy PC cannot break it.
TEST(Worker, WaitsLongerEachTimeForAMasterThatThrowsItOut) {
  Door door;
  WorkerOptions options = worker_for(door.address(), "lab7");
  options.backoff = {40ms, 60s};
  WorkerThread worker(options, prepare_positions);
  const auto begun = std::chrono::steady_clock::now();
  for (int time = 0; time < 5; ++time) MasterAtDoor(door).welcome();
  EXPECT_GE(std::chrono::steady_clock::now() - begun, 300ms) << "half of 40, 80, 160 and 320 ms";
}

TEST(Worker, LeavesASilentMaster) {
  Door door;
  WorkerOptions options = worker_for(door.address(), "lab7");
  options.times.connection = {10ms, 50ms, 50ms};
  WorkerThread worker(options, prepare_positions);
  MasterAtDoor silent(door);
  silent.welcome();
  silent.wait_for_end();
  MasterAtDoor next(door);
}

TEST(Worker, StopsARevokedTileInTheMiddle) {
  Gate gate;
  Door door;
  WorkerThread worker(worker_for(door.address(), "lab7"), gate.prepare());
  MasterAtDoor master(door);
  master.welcome();
  master.start_job();
  master.assign(1, 0);
  gate.wait_for_begun(1);
  master.send(Revoke{{LeaseId{1}}});
  master.assign(2, 1);
  gate.wait_for_begun(2);  // its only thread is free again
  gate.open();
  EXPECT_EQ(master.receive_a<Result>().lease, LeaseId{2});
}

TEST(Worker, HandsBackWhatItHasNotBegunWhenItStops) {
  Gate gate;
  Door door;
  WorkerThread worker(worker_for(door.address(), "lab7"), gate.prepare());
  MasterAtDoor master(door);
  master.welcome();
  master.start_job();
  for (std::uint64_t lease = 1; lease <= 3; ++lease) master.assign(lease, 0);
  gate.wait_for_begun(1);
  // All three are there once the answer to a fourth is.
  master.send(Assignment{LeaseId{4}, JobId{9}, 0, 0, 1});
  EXPECT_EQ(master.receive_a<GiveBack>().leases, std::vector{LeaseId{4}});
  worker.stop();
  EXPECT_EQ(master.receive(), ToMaster(GiveBack{{LeaseId{2}, LeaseId{3}}, ""}));
  gate.open();
  EXPECT_EQ(master.receive_a<Result>().lease, LeaseId{1});
  master.receive_a<Goodbye>();
  worker.wait_for_end();
}

TEST(Worker, GivesBackWhatItCannotFinishInTimeWhenItStops) {
  Gate gate;
  Door door;
  WorkerOptions options = worker_for(door.address(), "lab7");
  options.times.to_finish = 20ms;
  WorkerThread worker(options, gate.prepare());
  MasterAtDoor master(door);
  master.welcome();
  master.start_job();
  master.assign(1, 0);
  gate.wait_for_begun(1);
  worker.stop();
  EXPECT_EQ(master.receive(), ToMaster(GiveBack{{}, ""}));
  EXPECT_EQ(master.receive(), ToMaster(GiveBack{{LeaseId{1}}, ""}));
  master.receive_a<Goodbye>();
  worker.wait_for_end();
}

TEST(Worker, StopsAtOnceWhenItHasNoMaster) {
  Door door;
  WorkerThread worker(worker_for(door.address(), "lab7"), prepare_positions);
  worker.stop();
  worker.wait_for_end();
}

TEST(Worker, DoesNotDialAnotherPcUnlessTold) {
  WorkerThread worker(worker_for({"192.0.2.1", 5411}, "lab7"), prepare_positions);
  EXPECT_THROW(worker.wait_for_end(), ExposureError);
}

TEST(Worker, ThatListensServesOneMasterAtATime) {
  WorkerOptions options = patient_worker("lab7");
  options.way = AwaitMaster{{"127.0.0.1", 0}};
  WorkerThread worker(options, prepare_positions);
  {
    MasterByHand first, second;
    first.connect(worker.listening_at());
    EXPECT_EQ(first.receive_a<Hello>().name, "lab7");
    first.send(Welcome{"lab7"});
    second.connect(worker.listening_at());
    EXPECT_EQ(second.receive_a<Goodbye>().reason, "this worker works for another master");
  }
  // The first is gone; whoever comes once that was noticed is served.
  for (;;) {
    MasterByHand next;
    next.connect(worker.listening_at());
    if (std::holds_alternative<Hello>(next.receive())) break;
  }
}

TEST(Worker, ThatListensDoesSoOnItsOwnPcUnlessTold) {
  asio::io_context io;
  WorkerOptions options = patient_worker("lab7");
  options.way = AwaitMaster{{"0.0.0.0", 0}};
  EXPECT_THROW(WorkerDaemon(io, options, prepare_positions), ExposureError);
  options.security.exposure = Exposure::insecure;
  EXPECT_NO_THROW(WorkerDaemon(io, options, prepare_positions));
}

TEST(Worker, NeedsANameThatCanBeShown) {
  EXPECT_NO_THROW(check(WorkerIdentity{"lab 7", "", 1}));
  EXPECT_THROW(check(WorkerIdentity{"", "", 1}), std::invalid_argument);
  EXPECT_THROW(check(WorkerIdentity{"bell\a", "", 1}), std::invalid_argument);
}

}  // namespace
}  // namespace rayfarm
