// The first law: who renders a picture, and with how many threads, is not to be seen in its file.

#include "tests/end_to_end/each_scene.h"

namespace rayfarm {
namespace {

TEST_P(EachScene, HasTheSameBytesWithOneAndTwoThreads) {
  EXPECT_TRUE(rendered_here(picture(), 1) == rendered_here(picture(), 2));
}

TEST_P(EachScene, HasTheSameBytesWhoeverRendersIt) {
  const std::string expected = rendered_here(picture());
  for (const int threads : {0, 1, 2})
    for (const int workers : {0, 1, 3}) {
      if (threads + workers == 0) continue;  // nobody
      SCOPED_TRACE(testing::Message() << threads << " threads of the master, " << workers << " workers");
      start_master({"--threads", std::to_string(threads)});
      for (int i = 0; i < workers; ++i) start_worker("pc" + std::to_string(i));
      wait_for_workers(static_cast<std::size_t>(workers) + (threads > 0 ? 1 : 0));

      EXPECT_TRUE(rendered_by_farm(picture()) == expected);
      const nlohmann::json views = FarmPrograms::workers();
      std::uint64_t delivered = 0;
      for (const auto& worker : views) delivered += std::uint64_t{worker.at("pixels")};
      EXPECT_EQ(delivered, 300u * 220u) << "each pixel was delivered once";
      kill_all();
    }
}

INSTANTIATE_TEST_SUITE_P(SameBytes, EachScene, testing::ValuesIn(all_scenes()), name_of_case);

}  // namespace
}  // namespace rayfarm
