#include "master/cli/local_render.h"

#include <gtest/gtest.h>

#include <atomic>

#include "common/render/render.h"
#include "tests/support/simple_job.h"

namespace rayfarm {
namespace {

RenderSettings small() {
  RenderSettings settings;
  settings.width = 150, settings.height = 90, settings.spp = 4;
  return settings;
}

const auto never = [] { return false; };

TEST(LocalRender, IsTheSamePictureForAnyNumberOfThreads) {
  const World world(simple_scene());
  Film expected({150, 90});
  RayCounters counters;
  for (std::uint32_t tile = 0; tile < tile_count(expected.size()); ++tile) {
    const auto images = render_tile(world, small(), tile, all_passes, never);
    for (const PassImage& image : *images) {
      expected.put(tile, image);
      counters += image.counters;
    }
  }
  for (const unsigned threads : {1u, 2u, 7u}) {
    const auto rendered = render_locally(world, small(), threads, never, [](const Film&) {});
    ASSERT_TRUE(rendered);
    EXPECT_TRUE(rendered->film.is_complete());
    EXPECT_EQ(rendered->film.rgb(), expected.rgb());
    EXPECT_EQ(rendered->counters, counters);
  }
}

TEST(LocalRender, ReturnsNothingWhenToldToStop) {
  const World world(simple_scene());
  std::atomic<int> asked{0};
  EXPECT_FALSE(render_locally(
      world, small(), 2, [&] { return ++asked > 100; }, [](const Film&) {}));
}

}  // namespace
}  // namespace rayfarm
