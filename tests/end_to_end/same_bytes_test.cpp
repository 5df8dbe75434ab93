// The first law: who renders a picture, and with how many threads, is not to be seen in its file.

#include "tests/end_to_end/each_scene.h"

namespace rayfarm {
namespace {

TEST_P(EachScene, HasTheSameBytesWithOneAndTwoThreads) {
  EXPECT_TRUE(rendered_here(picture(), 1) == rendered_here(picture(), 2));
}

INSTANTIATE_TEST_SUITE_P(Five, EachScene, testing::ValuesIn(five_scenes()), name_of_case);
INSTANTIATE_TEST_SUITE_P(Others, EachScene, testing::ValuesIn(other_scenes()), name_of_case);

class SceneOnFarms : public EachScene {
 protected:
  /// That nobody has got yet.
  void start_farm(int threads, int workers) {
    start_master({"--threads", std::to_string(threads)});
    for (int i = 0; i < workers; ++i) start_worker("pc" + std::to_string(i));
    wait_for_workers(static_cast<std::size_t>(workers) + (threads > 0 ? 1 : 0));
  }
};

TEST_P(SceneOnFarms, HasTheSameBytesWhoeverRendersIt) {
  const std::string expected = rendered_here(picture());
  for (const int threads : {0, 1, 2})
    for (const int workers : {0, 1, 3}) {
      if (threads + workers == 0) continue;  // nobody
      SCOPED_TRACE(testing::Message() << threads << " threads of the master, " << workers << " workers");
      start_farm(threads, workers);
      EXPECT_TRUE(rendered_by_farm(picture()) == expected);
      const nlohmann::json views = FarmPrograms::workers();
      std::uint64_t delivered = 0;
      for (const auto& worker : views) delivered += std::uint64_t{worker.at("pixels")};
      EXPECT_EQ(delivered, 300u * 220u) << "each pixel was delivered once";
      kill_all();
    }
}

INSTANTIATE_TEST_SUITE_P(Five, SceneOnFarms, testing::ValuesIn(five_scenes()), name_of_case);

class SceneOnAFarm : public SceneOnFarms {};

TEST_P(SceneOnAFarm, HasTheSameBytes) {
  start_farm(1, 2);
  EXPECT_TRUE(rendered_by_farm(picture()) == rendered_here(picture()));
}

INSTANTIATE_TEST_SUITE_P(Others, SceneOnAFarm, testing::ValuesIn(other_scenes()), name_of_case);

}  // namespace
}  // namespace rayfarm
