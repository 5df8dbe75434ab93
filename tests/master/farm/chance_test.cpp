// The farm under chance.
#include <gtest/gtest.h>

#include "tests/master/farm/chaos.h"

namespace rayfarm {
namespace {

TEST(Farm, CommitsEachPassOfEachTileExactlyOnceWhateverHappens) {
  std::size_t done = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Chaos chaos(seed);
    chaos.run(1500);
    done += chaos.finish();
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(done, 200u) << "too little was seen to its end";
}

}  // namespace
}  // namespace rayfarm
