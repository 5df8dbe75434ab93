// A real worker among the others delivers wrong pixels: it is banned, and each picture has the right bytes.
#include "tests/end_to_end/each_scene.h"

namespace rayfarm {
namespace {

struct LyingCase {
  std::string lie, verify;
};
void PrintTo(const LyingCase& lying, std::ostream* out) {
  *out << lying.lie << ", --verify " << lying.verify;
}

class AmongLiars : public FarmPrograms, public testing::WithParamInterface<LyingCase> {};

TEST_P(AmongLiars, PicturesAreRightAndTheLiarIsBanned) {
  const Words picture = five_scenes().front().picture;
  const std::string right = rendered_here(picture);
  start_master({"--threads", "0"});
  start_program("liar", {"lying_worker", farm_address(), "liar", GetParam().lie, "1"});
  start_worker("one"), start_worker("two");
  wait_for_workers(3);
  const auto is_banned = [&] { return log_of("master").find("worker liar banned") != std::string::npos; };
  for (int job = 0; job < 20 && !is_banned(); ++job) {
    const std::string id = submit(picture, {"--verify", GetParam().verify});
    wait_for_state(id, "done");
    EXPECT_TRUE(fetched(id) == right) << "job " << id;
  }
  EXPECT_TRUE(is_banned());
}

// Without verification only what is no number at all is seen; then nothing of its worker stays.
INSTANTIATE_TEST_SUITE_P(Lies, AmongLiars,
                         testing::Values(LyingCase{"ulp", "audit=1"}, LyingCase{"ulp", "quorum=2"},
                                         LyingCase{"percent", "audit=1"}, LyingCase{"percent", "quorum=2"},
                                         LyingCase{"nan", "none"}, LyingCase{"nan", "quorum=2"}));

}  // namespace
}  // namespace rayfarm
