// A master whose disk is full: its jobs wait and say why, and go on where they were when there is room.
#include "tests/end_to_end/farm_programs.h"
#include "tests/support/failing_disk.h"

namespace rayfarm {
namespace {

class SmallDisk : public FarmPrograms {
 protected:
  /// With a disk of 24 MB in `disk`.
  void run_on_small_disk(const std::function<void()>& body) {
    std::filesystem::create_directory(disk);
    run_apart([&] { return enter_small_disk(disk, 24 << 20); }, body);
  }
  void fill() const {
    std::ofstream file(disk / "fill", std::ios::binary);
    const std::string page(4096, 'x');
    while (file.write(page.data(), 4096).flush()) {}
  }
  void make_room() const { std::filesystem::remove(disk / "fill"); }
  void start(const std::string& listen = "127.0.0.1:0") {
    start_master({"--threads", "0", "--state", disk / "state"}, listen);
  }
  void start_with_worker() {
    start();
    start_worker("pc0");
    wait_for_workers(1);
  }

  const std::filesystem::path disk = folder / "disk";
  const Words picture{scene_file("circus"), "--size", "512x384", "--spp", "16"};
};

TEST_F(SmallDisk, PausesItsJobsWhenItIsFullAndTakesThemUpAgain) {
  run_on_small_disk([&] {
    start_with_worker();
    const std::string id = submit(picture);
    wait_for_pixels(id);
    fill();
    wait_for_state(id, "paused");
    EXPECT_NE(job(id).at("message").get<std::string>().find("full; make room there"), std::string::npos);
    const ProgramResult in_vain = rayfarm({"resume", id});
    EXPECT_NE(in_vain.exit_code, 0);
    EXPECT_NE(in_vain.err.find("full"), std::string::npos) << in_vain.err;
    EXPECT_EQ(state_of(id), "paused");

    make_room();
    EXPECT_EQ(rayfarm({"resume", id}).exit_code, 0) << "the first time that there is room";
    wait_for_state(id, "done");
    EXPECT_TRUE(fetched(id) == rendered_here(picture));
  });
}

TEST_F(SmallDisk, LosesNothingThatWasDoneBeforeItWasFull) {
  run_on_small_disk([&] {
    start_with_worker();
    const std::string id = submit(picture);
    wait_for_pixels(id);
    const std::uint64_t seen = pixels_of(id);
    fill();
    wait_for_state(id, "paused");
    kill_master();
    make_room();
    start(farm_address());
    EXPECT_GE(pixels_of(id), seen);
    wait_for_workers(1);
    rayfarm({"resume", id});
    wait_for_state(id, "done");
    EXPECT_TRUE(fetched(id) == rendered_here(picture));
  });
}

}  // namespace
}  // namespace rayfarm
