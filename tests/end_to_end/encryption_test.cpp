// What goes over a network: the real programs in a network of their own, all of whose packets are looked at.
#include "tests/end_to_end/farm_programs.h"
#include "tests/support/own_network.h"

namespace rayfarm {
namespace {

const std::string here = "10.77.0.1";  // not loopback, so treated as any other PC's

using Streams = std::map<std::string, std::string>;

/// What of a stream is no TLS 1.3; empty: all is. After the hellos all records say that they are application data
/// (RFC 8446, 5.1), but for one byte that is there for old boxes on the way (D.4).
std::string plaintext_in(const std::string& stream) {
  constexpr char change_cipher = 20, handshake = 22, application = 23;
  bool is_secret = false;
  for (std::size_t at = 0; at < stream.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(stream.c_str()[at + i]); };
    if (at + 5 > stream.size()) return "";  // killed in the middle
    const char type = stream[at];
    const std::size_t size = byte(3) * 256u + byte(4);
    const bool is_one =
        byte(1) == 3 && size <= 16640 &&
        ((type == handshake && !is_secret) || (type == change_cipher && size == 1) || type == application);
    if (!is_one) return stream.substr(at, 80);
    is_secret = is_secret || type == application;
    at += 5 + size;
  }
  return "";
}

bool holds(const Streams& streams, const std::string& words) {
  return std::ranges::any_of(streams,
                             [&](const auto& s) { return s.second.find(words) != std::string::npos; });
}

class Encryption : public FarmPrograms {
 protected:
  void run_in_own_network(const std::function<void()>& body) {
    run_apart([] { return enter_own_network(here); }, body);
  }

  ProgramResult command(const Words& words) const {
    return run_program(Words{"rayfarm"} + words,
                       {{"RAYFARM_MASTER", http()}, {"RAYFARM_TOKEN_FILE", folder / "farm/admin.token"}});
  }
  void join(const std::string& code, const std::string& name) const {
    const ProgramResult joined =
        run_program({"rayfarm-worker", "join", code, "--name", name, "--state", folder / name});
    ASSERT_EQ(joined.exit_code, 0) << joined.err;
  }
  void wait_for_log(const std::string& words) const {
    wait_until("the master says: " + words,
               [&] { return log_of("master").find(words) != std::string::npos; });
  }
};

const Words small_picture{scene_file("sphere_flake"), "--size", "96x64", "--spp", "1"};

TEST_F(Encryption, LeavesNoPlaintextOnANetwork) {
  run_in_own_network([&] {
    PacketCapture capture;
    start_master({"--threads", "0", "--state", folder / "farm", "--http", here + ":0", "--dial",
                  "waits=" + here + ":5413"},
                 here + ":0");
    const ProgramResult made = command({"token", "new", "--uses", "2"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const std::string code = made.out.substr(0, made.out.find('\n'));
    join(code, "dials");
    join(code, "waits");
    start_worker_with("dials", {"--state", folder / "dials", "--threads", "1"});
    start_worker_with("waits", {"--state", folder / "waits", "--threads", "1", "--listen", here + ":5413"});
    wait_for_log("worker dials joined");
    wait_for_log("worker waits joined");
    const ProgramResult rendered =
        command(Words{"submit"} + small_picture + Words{"-o", folder / "job.exr", "--wait"});
    EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
    EXPECT_EQ(content_of(folder / "job.exr"), rendered_here(small_picture));
    kill_all();

    const Streams streams = capture.streams();
    EXPECT_GE(streams.size(), 2u * 7)
        << "two workers that join, two that work, three commands; each both ways";
    for (const auto& [way, bytes] : streams) EXPECT_EQ(plaintext_in(bytes), "") << way;
    for (const std::string& word :
         {code.substr(0, 47), std::string("RYFM"), std::string("HTTP/"), std::string("dials"),
          content_of(folder / "farm/admin.token").substr(0, 47)})
      EXPECT_FALSE(holds(streams, word)) << word;
  });
}

TEST_F(Encryption, AnswersPlaintextFromANetworkWithNothing) {
  run_in_own_network([&] {
    PacketCapture capture;
    start_master({"--threads", "0", "--state", folder / "farm", "--http", here + ":0"}, here + ":0");
    const std::string plain = "http" + http().substr(5);
    EXPECT_NE(run_program({"rayfarm", "jobs"}, {{"RAYFARM_MASTER", plain}}).exit_code, 0);
    start_worker_with("stranger", {"--master", farm_address(), "--insecure", "--state", folder / "stranger"});
    wait_for_log("it does not encrypt what it says");
    kill_all();
    int asked = 0;
    for (const auto& [way, bytes] : capture.streams()) {
      const bool is_from_master = way.starts_with(farm_address()) || way.starts_with(http().substr(8));
      if (is_from_master)
        EXPECT_EQ(bytes, "") << way;
      else
        ++asked;
    }
    EXPECT_GE(asked, 2) << "the capture sees who asks";
  });
}

TEST_F(Encryption, IsMissedByThisCaptureWhereThereIsNone) {
  run_in_own_network([&] {
    PacketCapture capture;
    start_master({"--threads", "0", "--insecure", "--http", here + ":0"}, here + ":0");
    start_worker_with("lab7", {"--master", farm_address(), "--insecure", "--state", folder / "lab7"});
    wait_for_log("worker lab7 joined");
    EXPECT_EQ(rayfarm({"jobs"}).exit_code, 0);
    kill_all();
    const Streams streams = capture.streams();
    for (const char* word : {"RYFM", "HTTP/", "lab7"}) EXPECT_TRUE(holds(streams, word)) << word;
    EXPECT_TRUE(std::ranges::any_of(streams, [](const auto& s) { return !plaintext_in(s.second).empty(); }));
  });
}

}  // namespace
}  // namespace rayfarm
