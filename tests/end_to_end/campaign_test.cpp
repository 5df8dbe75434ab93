// Renders on a farm to which everything happens that can: master and workers die, workers hang, and the network between
// them does to their connections what a bad one does. Each picture has the bytes of an undisturbed one.
//
// RAYFARM_CAMPAIGN is how many renders (20), RAYFARM_CAMPAIGN_SEED the first one's seed (1).
#include <signal.h>

#include <array>
#include <random>

#include "tests/end_to_end/each_scene.h"
#include "tests/support/fault_proxy.h"

namespace rayfarm {
namespace {

unsigned number_of(const char* variable, unsigned otherwise) {
  const char* text = std::getenv(variable);
  return text ? static_cast<unsigned>(std::stoul(text)) : otherwise;
}

class Campaign : public FarmPrograms {
 protected:
  static constexpr unsigned workers = 3;
  static std::string name_of(unsigned worker) { return "pc" + std::to_string(worker); }

  void start_the_master(const std::string& at = "127.0.0.1:0") {
    start_master({"--threads", "0", "--state", folder / "state"}, at);
  }
  /// Something happens to the master or to one of the workers, at an instant that nobody waits for.
  void disturb(const FaultProxy& network, std::mt19937& random) {
    const auto pause = [&](unsigned most) {
      std::this_thread::sleep_for(std::chrono::milliseconds(random() % most));
    };
    pause(200);
    const std::string victim = name_of(random() % workers);
    switch (random() % 4) {
      case 0:
        kill_worker(victim);
        start(victim, network);
        break;
      case 1:
        worker(victim).send_signal(SIGSTOP);
        pause(2500);  // sometimes so long that it is given up
        worker(victim).send_signal(SIGCONT);
        break;
      case 2:
        kill_master();
        ++crashes_;
        start_the_master(farm_address());
        break;
      default:
        break;  // the network does enough
    }
  }
  void start(const std::string& name, const FaultProxy& network) {
    start_worker_with(name, {"--master", network.address(), "--threads", "1"});
  }
  /// A picture, while things happen; how many tiles were given back.
  std::uint64_t render(unsigned seed, const Words& options, const std::string& liars_lie = "") {
    std::mt19937 random(seed);
    FaultProxy network(parse_address(farm_address(), 0), seed);
    for (unsigned i = 0; i < workers; ++i) start(name_of(i), network);
    const std::string liar = "liar" + std::to_string(seed);  // the last one is banned
    if (!liars_lie.empty())
      start_program(liar, {"lying_worker", network.address(), liar, liars_lie, std::to_string(seed)});
    const Words picture = five_scenes()[random() % five_scenes().size()].picture;
    const std::string id = submit(picture, options);
    for (int deed = 0; deed < 8 && state_of(id) != "done"; ++deed) disturb(network, random);
    network.calm();
    if (state_of(id) == "paused") rayfarm({"resume", id});  // it was being rendered at two crashes in a row
    wait_for_state(id, "done");
    EXPECT_TRUE(fetched(id) == undisturbed(picture)) << "seed " << seed << "\n" << network.story();
    const std::uint64_t back = job(id).at("tiles_given_back").get<std::uint64_t>();
    std::printf("seed %u: %zu bytes right, %llu tiles given back\n", seed, undisturbed(picture).size(),
                static_cast<unsigned long long>(back));
    std::fflush(stdout);  // also when it is a file: a campaign is long
    for (unsigned i = 0; i < workers; ++i) kill_worker(name_of(i));
    kill_worker(liar);
    return back;
  }
  unsigned crashes() const { return crashes_; }  // of the master
  const std::string& undisturbed(const Words& picture) {
    std::string& bytes = undisturbed_[picture];
    if (bytes.empty()) bytes = rendered_here(picture);
    return bytes;
  }

 private:
  unsigned crashes_ = 0;
  std::map<Words, std::string> undisturbed_;
};

TEST_F(Campaign, EveryPictureHasTheBytesOfAnUndisturbedOne) {
  const unsigned renders = number_of("RAYFARM_CAMPAIGN", 20), first = number_of("RAYFARM_CAMPAIGN_SEED", 1);
  start_the_master();
  std::uint64_t given_back = 0;
  for (unsigned seed = first; seed < first + renders; ++seed) given_back += render(seed, {});
  std::printf("the master was killed %u times\n", crashes());
  EXPECT_GT(given_back + crashes(), renders) << "too little was disturbed";
}

TEST_F(Campaign, EveryPictureIsRightAlsoWhenAWorkerLies) {
  const unsigned renders = number_of("RAYFARM_CAMPAIGN", 20) / 4,
                 first = number_of("RAYFARM_CAMPAIGN_SEED", 1);
  start_the_master();
  for (unsigned seed = first; seed < first + renders; ++seed) {
    const std::string verify = seed % 2 ? "quorum=2" : "audit=1";
    render(seed, {"--verify", verify}, std::array{"ulp", "percent", "nan"}[seed % 3]);
  }
}

}  // namespace
}  // namespace rayfarm
