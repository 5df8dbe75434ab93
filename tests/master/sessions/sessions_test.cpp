// The door alone: what it makes of peers that the test speaks for.
#include "master/sessions.h"

#include <gtest/gtest.h>

#include <chrono>
#include <list>

#include "common/work/engine.h"
#include "tests/support/farm_jobs.h"
#include "tests/support/framed_socket.h"
#include "tests/support/master_thread.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

/// It takes whole tiles only.
Hello hello_from(std::string name) {
  return {{protocol_version, oldest_protocol_version, can_reattach},
          "0.1.0",
          std::move(name),
          "a test's CPU",
          1,
          engine_fingerprint()};
}

/// Connected, not a word said.
struct Peer : WorkerByHand {
  explicit Peer(const MasterThread& master) { connect(master.address()); }
};
/// Welcomed under the name that it asked for.
struct Guest : Peer {
  Guest(const MasterThread& master, std::string name) : Peer(master) {
    send(hello_from(name));
    EXPECT_EQ(receive_a<Welcome>().name, name);
  }
  /// The next assignment, whatever is said before.
  Assignment next_assignment() {
    for (;;)
      if (const ToWorker message = receive(); const auto* assignment = std::get_if<Assignment>(&message))
        return *assignment;
  }
};

JobId submit(MasterThread& master, RenderSettings settings) {
  return master.ask([&](Farm& farm, FarmTime now) { return farm.submit(simple_job(settings), now); });
}

constexpr RenderSettings one_tile{.width = 64, .height = 64};

TEST(Sessions, TakeAWorkerInAndGiveItWork) {
  MasterThread master;
  Guest guest(master, "lab7");
  const JobId job = submit(master, one_tile);
  EXPECT_EQ(guest.receive_a<SceneData>().hash, scene_data(simple_scene()).hash);
  EXPECT_EQ(guest.receive_a<FrameStart>().job, job);
  const auto assignment = guest.receive_a<Assignment>();
  EXPECT_EQ(assignment.passes, all_passes);
  guest.send(Result{assignment.lease, job, 0, 0,
                    *position_tile(one_tile, 0, all_passes, [] { return false; }), 0.1});
  EXPECT_EQ(guest.receive_a<FrameEnd>().job, job);
  const Film film = *master.ask([&](Farm& farm, FarmTime) { return farm.film(job); });
  EXPECT_EQ(film.rgb(), rendered(position_area, one_tile).rgb());
}

TEST(Sessions, GiveAWorkerOfManyThreadsPiecesOfTheOnlyTile) {
  MasterThread master;
  Peer peer(master);
  Hello hello = hello_from("lab7");
  hello.threads = 4, hello.versions.capabilities |= can_take_pieces;
  peer.send(hello);
  peer.receive_a<Welcome>();
  const JobId job = submit(master, one_tile);
  for (int pieces = 0; pieces < 4;) {
    const ToWorker message = peer.receive();
    const auto* piece = std::get_if<PieceAssignment>(&message);
    if (!piece) continue;
    ++pieces;
    peer.send(
        PieceResult{{piece->work.lease, job, 0, 0,
                     *position_area(one_tile, piece->area, piece->work.passes, [] { return false; }), 0.1},
                    piece->area});
  }
  while (!std::holds_alternative<FrameEnd>(peer.receive())) {}
  const Film film = *master.ask([&](Farm& farm, FarmTime) { return farm.film(job); });
  EXPECT_EQ(film.rgb(), rendered(position_area, one_tile).rgb());
}

TEST(Sessions, GiveAWorkerThatKnowsNoPiecesWholeTiles) {
  MasterThread master;
  Peer peer(master);
  Hello hello = hello_from("lab7");
  hello.threads = 4;
  peer.send(hello);
  peer.receive_a<Welcome>();
  const JobId job = submit(master, one_tile);
  peer.receive_a<SceneData>();
  peer.receive_a<FrameStart>();
  const auto assignment = peer.receive_a<Assignment>();
  peer.send(Result{assignment.lease, job, 0, 0, *position_tile(one_tile, 0, all_passes, [] { return false; }),
                   0.1});
  EXPECT_EQ(peer.receive_a<FrameEnd>().job, job);
}

TEST(Sessions, RefuseAnotherProtocolAndSayWhatToDo) {
  MasterThread master;
  Peer peer(master);
  Hello hello = hello_from("lab7");
  hello.versions = {6, 5, 0};
  peer.send(hello);
  EXPECT_EQ(
      peer.receive_a<Refused>().reason,
      "rayfarm 0.1.0 speaks protocols 5 to 6, this master (0.1.0) protocol 4: install the same version on "
      "both PCs");
  peer.wait_for_end();
}

TEST(Sessions, SpeakTheNewestProtocolAndTheCapabilitiesThatBothHave) {
  MasterThread master;
  Peer peer(master);
  Hello hello = hello_from("from the future");
  hello.versions = {9, 2, 0b101};
  peer.send(hello);
  EXPECT_EQ(peer.receive_a<Welcome>().versions, (Versions{protocol_version, protocol_version, can_reattach}));
}

TEST(Sessions, RefuseARendererThatMakesOtherBits) {
  MasterThread master;
  Peer peer(master);
  Hello hello = hello_from("lab7");
  hello.engine = std::string(64, '0');
  peer.send(hello);
  const std::string reason = peer.receive_a<Refused>().reason;
  EXPECT_NE(reason.find("engine 00000000"), std::string::npos) << reason;
  EXPECT_NE(reason.find("install the same build on both PCs"), std::string::npos) << reason;
  peer.wait_for_end();
}

TEST(Sessions, RefuseAPeerThatDoesNotSayHello) {
  MasterThread master;
  const std::vector<std::pair<Bytes, std::string>> cases = {
      {encode(ToMaster{GiveBack{}}), "the first message must be Hello"},
      {Bytes{'G', 'E', 'T', ' ', '/', ' ', 'H', 'T', 'T', 'P', '/', '1', '.', '1', '\r', '\n', '\r', '\n'},
       "the peer does not speak rayfarm's protocol"},
      {encode(ToMaster{hello_from("")}), "a worker needs a name: give it one with --name"},
      {encode(ToMaster{Hello{{}, "0.1.0", "lab7", "", 0, engine_fingerprint()}}),
       "a worker has 1 to 4096 threads, not 0"},
  };
  for (const auto& [bytes, reason] : cases) {
    Peer peer(master);
    peer.send_bytes(bytes);
    EXPECT_EQ(peer.receive_a<Refused>().reason, reason);
    peer.wait_for_end();
  }
  EXPECT_TRUE(master.ask([](Farm& farm, FarmTime) { return farm.workers(); }).empty());
}

TEST(Sessions, EndWithWhoBeginsWithALargeMessage) {
  MasterThread master;
  Peer peer(master);
  peer.send(GiveBack{std::vector<LeaseId>(8'000), ""});
  EXPECT_NE(peer.receive_a<Refused>().reason.find("too early"), std::string::npos);
  peer.wait_for_end();
}

TEST(Sessions, LetTheOldestStrangerGoWhenThereAreTooManyAndNoWorker) {
  MasterThread master(DoorLimits{{100ms, 60s, 60s}, {1ms, 10ms}, 4});
  Guest worker(master, "lab7");
  std::list<Peer> strangers;
  for (int i = 0; i < 7; ++i) strangers.emplace_back(master);
  for (int i = 0; i < 3; ++i) {
    strangers.front().wait_for_end();
    strangers.pop_front();
  }
  strangers.back().send(hello_from("lab8"));
  EXPECT_EQ(strangers.back().receive_a<Welcome>().name, "lab8");
  submit(master, one_tile);
  worker.next_assignment();
}

TEST(Sessions, EndWithAPeerThatOnlyBeats) {
  MasterThread master(DoorLimits{{10ms, 60s, 30ms}, {}});
  Peer peer(master);
  peer.send(Heartbeat{});
  peer.wait_for_end();
}

TEST(Sessions, GiveATileToTheNextWhenASocketDies) {
  MasterThread master;  // whose patience with silence is a minute
  auto first = std::make_unique<Guest>(master, "first");
  Guest second(master, "second");
  submit(master, one_tile);
  const std::uint32_t tile = first->next_assignment().tile;
  first.reset();
  EXPECT_EQ(second.next_assignment().tile, tile);
  master.wait_for_workers(1);
}

TEST(Sessions, GiveATileToTheNextWhenAWorkerIsSilent) {
  MasterThread master(DoorLimits{{10ms, 100ms, 100ms}, {}});
  Guest silent(master, "silent");
  submit(master, one_tile);
  const std::uint32_t tile = silent.next_assignment().tile;
  master.wait_for_workers(0);
  Guest next(master, "next");
  EXPECT_EQ(next.next_assignment().tile, tile);
}

// A worker notices a cut at once, its master only by the silence: here after a minute.
TEST(Sessions, TakeAWorkerInAgainWhoseOldConnectionIsNotNoticedDead) {
  MasterThread master;
  Hello hello = hello_from("pc");
  hello.process = 7;
  Peer cut(master);
  cut.send(hello);
  EXPECT_EQ(cut.receive_a<Welcome>().name, "pc");
  Peer again(master);
  again.send(hello);
  EXPECT_EQ(again.receive_a<Welcome>().name, "pc");
  cut.receive_a<Goodbye>();
  cut.send(GiveBack{{LeaseId{1}}, "from the grave"});
  cut.wait_for_end();
  master.wait_for_workers(1);
  Guest other(master, "pc-2");
}

TEST(Sessions, EndWithAWorkerThatLies) {
  MasterThread master;
  const JobId job = submit(master, one_tile);
  const auto lies = [&](const Assignment& a) {
    const auto images = *position_tile(one_tile, 0, all_passes, [] { return false; });
    auto short_of_a_pass = images, short_of_a_pixel = images;
    short_of_a_pass.pop_back();
    short_of_a_pixel.back().rgb.resize(short_of_a_pixel.back().rgb.size() - 3);
    return std::vector<Bytes>{encode(ToMaster{Result{a.lease, job, 0, 1, images, 0.1}}),
                              encode(ToMaster{Result{a.lease, job, 0, 0, short_of_a_pass, 0.1}}),
                              encode(ToMaster{Result{a.lease, job, 0, 0, short_of_a_pixel, 0.1}}),
                              encode(ToMaster{hello_from("again")}), Bytes(100, 0xff)};
  };
  for (std::size_t i = 0; i < 5; ++i) {
    Guest liar(master, "liar" + std::to_string(i));
    liar.send_bytes(lies(liar.next_assignment())[i]);
    liar.wait_for_end();
    master.wait_for_workers(0);
  }
  EXPECT_EQ(master.ask([&](Farm& farm, FarmTime now) { return farm.job(job, now); })->pixels_done, 0u);
}

// Only a lower bound of time is checked: a busy PC cannot break it.
TEST(Sessions, WaitLongerEachTimeForADialledWorkerThatIsThrownOut) {
  MasterThread master(DoorLimits{{100ms, 60s, 60s}, {40ms, 60s}});
  asio::io_context io;
  asio::ip::tcp::acceptor door(io, {asio::ip::address_v4::loopback(), 0});
  const auto begun = std::chrono::steady_clock::now();
  master.dial({"liar", {"127.0.0.1", door.local_endpoint().port()}});
  for (int time = 0; time < 5; ++time) {
    WorkerByHand liar;
    liar.accept(door);
    liar.send(hello_from("liar"));
    EXPECT_EQ(liar.receive_a<Welcome>().name, "liar");
    liar.send(hello_from("again"));
    liar.wait_for_end();
  }
  EXPECT_GE(std::chrono::steady_clock::now() - begun, 300ms) << "half of 40, 80, 160 and 320 ms";
}

TEST(Sessions, EndWithABannedWorkerAndRefuseItUntilItIsUnbanned) {
  MasterThread master;
  Guest guest(master, "lab7");
  EXPECT_TRUE(master.ask([](Farm& farm, FarmTime now) { return farm.ban("lab7", now); }));
  EXPECT_NE(guest.receive_a<Refused>().reason.find("lab7 is banned"), std::string::npos);
  guest.wait_for_end();
  master.wait_for_workers(0);

  Peer again(master);
  again.send(hello_from("lab7"));
  EXPECT_NE(again.receive_a<Refused>().reason.find("rayfarm unban lab7"), std::string::npos);
  again.wait_for_end();
  EXPECT_TRUE(master.ask([](Farm& farm, FarmTime now) { return farm.unban("lab7", now); }));
  Guest(master, "lab7");
}

TEST(Sessions, TellOfADialledWorkerWhyItIsNotReached) {
  MasterThread master;
  asio::io_context io;
  asio::ip::tcp::acceptor door(io, {asio::ip::address_v4::loopback(), 0});
  const Address address{"127.0.0.1", door.local_endpoint().port()};
  door.close();  // nobody is there
  master.dial({"lab7", address});
  std::vector<Dialling> dialling;
  do dialling = master.ask([&](Farm&, FarmTime) { return master.door().dialling(); });
  while (dialling.at(0).message.empty());
  ASSERT_EQ(dialling.size(), 1u);
  EXPECT_EQ(dialling[0].name, "lab7");
  EXPECT_EQ(dialling[0].address, text_of(address));
  const std::vector<LogLine> log = master.ask([&](Farm&, FarmTime) { return master.door().log(0); });
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log[0].number, 1u);
  EXPECT_EQ(log[0].event.worker, "lab7");
  EXPECT_TRUE(log[0].event.warning);

  door = asio::ip::tcp::acceptor(io, {asio::ip::address_v4::loopback(), address.port});
  WorkerByHand worker;
  worker.accept(door);
  worker.send(hello_from("its own name"));
  EXPECT_EQ(worker.receive_a<Welcome>().name, "lab7");
  EXPECT_TRUE(master.ask([&](Farm&, FarmTime) { return master.door().dialling().empty(); }));
}

constexpr Address nobody{"127.0.0.1", 1};

bool stop_dialling(MasterThread& master, const std::string& name) {
  return master.ask([&](Farm&, FarmTime) { return master.door().stop_dialling(name); });
}
std::string refusal_of(MasterThread& master, const std::string& name) {
  try {
    master.dial({name, nobody});
  } catch (const NameInUse& error) {
    return error.what();
  }
  return "";
}

// A mistyped dial once stood beside the healthy worker under its name: who banned the one banned the other.
TEST(Sessions, DialNoNameThatIsInUse) {
  MasterThread master;
  Guest guest(master, "here");
  EXPECT_EQ(refusal_of(master, "here"),
            "a worker \"here\" is here already; dial the new one by another name");
  EXPECT_EQ(refusal_of(master, "asleep"), "");
  EXPECT_EQ(refusal_of(master, "asleep"),
            "\"asleep\" is dialled already, at 127.0.0.1:1: stop that first (DELETE "
            "/api/v1/workers/dial/asleep), or choose another name");
  master.ask([](Farm& farm, FarmTime now) { return farm.ban("here", now); });
  guest.receive_a<Refused>();
  master.wait_for_workers(0);
  EXPECT_NE(refusal_of(master, "here").find("rayfarm unban here"), std::string::npos);
}

TEST(Sessions, DialNoLongerWhatTheyShallNot) {
  MasterThread master;
  EXPECT_FALSE(stop_dialling(master, "asleep"));
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(refusal_of(master, "asleep"), "");
    EXPECT_TRUE(stop_dialling(master, "asleep"));
    EXPECT_FALSE(stop_dialling(master, "asleep"));
    EXPECT_TRUE(master.ask([&](Farm&, FarmTime) { return master.door().dialling().empty(); }));
  }
}

TEST(Sessions, KeepAWorkerThatIsHereWhenItIsNoLongerDialled) {
  MasterThread master;
  asio::io_context io;
  asio::ip::tcp::acceptor door(io, {asio::ip::address_v4::loopback(), 0});
  master.dial({"lab7", {"127.0.0.1", door.local_endpoint().port()}});
  WorkerByHand worker;
  worker.accept(door);
  worker.send(hello_from("lab7"));
  worker.receive_a<Welcome>();
  EXPECT_TRUE(stop_dialling(master, "lab7"));
  submit(master, one_tile);
  worker.receive_a<SceneData>();
}

TEST(Sessions, SayGoodbyeToAllWhenTheMasterStops) {
  MasterThread master;
  Guest one(master, "one"), two(master, "two");
  Peer three(master);
  master.stop();
  for (Guest* guest : {&one, &two}) {
    EXPECT_EQ(guest->receive_a<Goodbye>().reason, "the master stops");
    guest->wait_for_end();
  }
  three.wait_for_end();
  master.wait_for_end();
}

TEST(Sessions, StayOnTheirOwnPcUnlessTold) {
  asio::io_context io;
  LiveFarm farm;
  EXPECT_THROW(Sessions(io, farm, {"0.0.0.0", 0}, Security{}), ExposureError);
  EXPECT_NO_THROW(Sessions(io, farm, {"0.0.0.0", 0}, Security{Exposure::insecure}));
}

TEST(DialTarget, HasANameAndAnAddress) {
  const DialTarget target = parse_dial_target("lab7=192.168.1.7:80");
  EXPECT_EQ(target.name, "lab7");
  EXPECT_EQ(target.address, (Address{"192.168.1.7", 80}));
  EXPECT_EQ(parse_dial_target("a=b").address.port, default_farm_port);
  for (const char* text : {"", "lab7", "=host", "lab7=", "lab7=host:x", "lab7=host:0"})
    EXPECT_THROW(parse_dial_target(text), AddressError) << text;
}

}  // namespace
}  // namespace rayfarm
