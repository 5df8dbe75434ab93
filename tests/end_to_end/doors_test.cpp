// How workers and others come to the master.
#include "tests/end_to_end/farm_programs.h"
#include "tests/support/raw_peer.h"

namespace rayfarm {
namespace {

class Doors : public FarmPrograms {
 protected:
  void expect_the_farm_renders() { EXPECT_TRUE(rendered_by_farm(picture) == rendered_here(picture)); }
  std::uint16_t farm_port() const {
    return static_cast<std::uint16_t>(std::stoi(farm_address().substr(farm_address().rfind(':') + 1)));
  }

  const Words picture{scene_file("sphere_flake"), "--size", "200x150", "--spp", "1"};
};

TEST_F(Doors, AListeningWorkerIsDialledWhateverElseIsInTheList) {
  const std::string line = start_listening_worker("its own name");
  const std::string address = line.substr(line.rfind(' ') + 1);
  start_master({"--threads", "0", "--dial", "no address", "--dial", "far=no.such.host.invalid", "--dial",
                "wrong=127.0.0.1:99999", "--dial", "asleep=127.0.0.1:1", "--dial", "lab7=" + address});
  wait_until("lab7 is here", [&] { return is_here("lab7"); });
  expect_the_farm_renders();
  wait_until("the log names those that cannot be reached", [&] {
    const std::string log = log_of("master");
    return log.find("no address") != std::string::npos &&
           log.find("no.such.host.invalid") != std::string::npos &&
           log.find("127.0.0.1:99999") != std::string::npos && log.find("\"asleep\"") != std::string::npos;
  });
}

TEST_F(Doors, TwoToBeDialledByOneNameAreAMistake) {
  const ProgramResult run = run_program({"rayfarm-master", "--http", "127.0.0.1:0", "--listen", "127.0.0.1:0",
                                         "--dial", "w1=127.0.0.1:1", "--dial", "w1=127.0.0.1:2"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("two workers are named w1"), std::string::npos) << run.err;
}

TEST_F(Doors, GarbageAndSilenceAtTheWorkersPortHurtNobody) {
  start_master({"--threads", "0"});
  RawPeer silent(farm_port()), half(farm_port());
  half.send("\x01");
  std::string zeros(100'000, '\0'), ones(100'000, '\xff');
  for (const std::string& bytes : {std::string("GET / HTTP/1.1\r\nHost: farm\r\n\r\n"), zeros, ones}) {
    RawPeer peer(farm_port());
    peer.send(bytes);
    peer.rest();  // the master ends it
  }
  start_worker("pc");
  wait_for_workers(1);
  expect_the_farm_renders();
}

TEST_F(Doors, TwoWorkersOfOneNameAreToldApart) {
  start_master({"--threads", "0"});
  start_worker("pc");
  wait_for_workers(1);
  const ChildProgram second({"rayfarm-worker", "--master", farm_address(), "--name", "pc", "--threads", "1"},
                            {}, folder / "second.log");
  wait_for_workers(2);
  EXPECT_TRUE(is_here("pc"));
  EXPECT_TRUE(is_here("pc-2"));
}

TEST_F(Doors, OnlyLoopbackIsOpenUnlessToldOtherwise) {
  for (const Words& words :
       {Words{"rayfarm-master", "--listen", "0.0.0.0:0", "--http", "127.0.0.1:0"},
        Words{"rayfarm-master", "--listen", "127.0.0.1:0", "--http", "0.0.0.0:0"},
        Words{"rayfarm-worker", "--listen", "0.0.0.0:0"}, Words{"rayfarm-worker", "--master", "192.0.2.1"}}) {
    const ProgramResult result = run_program(words);
    EXPECT_EQ(result.exit_code, 2) << words[1] << " " << words[2];
    EXPECT_NE(result.err.find("--insecure"), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace rayfarm
