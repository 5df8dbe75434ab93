#include "master/diagnostics/collecting_render.h"

#include <gtest/gtest.h>

#include "common/render/render.h"
#include "common/work/each_tile.h"
#include "tests/support/random_scene.h"
#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

const std::function<bool()> never = [] { return false; };
const auto unheard = [](std::uint32_t, std::uint32_t) {};

RenderSettings small(SamplerKind sampler = SamplerKind::sobol) {
  RenderSettings s;
  s.width = 90, s.height = 70, s.spp = 4, s.sampler = sampler;
  return s;
}

std::vector<const MapKind*> kinds_of_scenes() {
  std::vector<const MapKind*> kinds;
  for (const MapKind& kind : all_maps())
    if (kind.put) kinds.push_back(&kind);
  return kinds;
}

bool render_all(CollectingRender& render, const RenderSettings& s, unsigned threads) {
  return each_tile(
      {s.width, s.height}, threads,
      [&](std::uint32_t tile) { return render.render_tile(tile, all_passes, never).has_value(); }, [] {});
}

TEST(CollectingRender, GivesTheMapsThatAreMadeWithoutThePicture) {
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::adapt1}) {
      const World world(seed % 2 ? random_scene(seed) : random_snapped_scene(seed));
      const RenderSettings s = small(sampler);
      CollectingRender render(world, s, kinds_of_scenes());
      ASSERT_TRUE(render_all(render, s, 3));
      for (std::size_t i = 0; i < kinds_of_scenes().size(); ++i) {
        const MapKind* kind = kinds_of_scenes()[i];
        if (kind->source == MapSource::time) continue;  // another time it is another one
        const Map alone = *map_of(world, s, {kind}, 2, never, unheard);
        EXPECT_EQ(render.maps()[i].values, alone.values) << kind->name << ", scene " << seed;
      }
    }
}

TEST(CollectingRender, RendersThePictureThatIsRenderedWithoutIt) {
  const ScratchFolder folder;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const World world(random_scene(seed));
    const RenderSettings s = small();
    CloudFile cloud_alone(folder / "a.ply", {}), cloud_too(folder / "b.ply", {});
    CollectingRender maps(world, s, kinds_of_scenes()), cloud(world, s, {}),
        both(world, s, kinds_of_scenes());
    cloud.also_collect(cloud_alone), both.also_collect(cloud_too);
    for (const std::uint32_t tile : centre_first({s.width, s.height})) {
      const auto plain = render_tile(world, s, tile, all_passes, never);
      EXPECT_EQ(maps.render_tile(tile, all_passes, never), plain);
      EXPECT_EQ(cloud.render_tile(tile, all_passes, never), plain);
      EXPECT_EQ(both.render_tile(tile, all_passes, never), plain);
    }
    EXPECT_EQ(cloud_alone.commit(), cloud_too.commit());
    EXPECT_EQ(content_of(folder / "a.ply"), content_of(folder / "b.ply"));
    EXPECT_EQ(both.maps()[0].values, maps.maps()[0].values);
  }
}

TEST(CollectingRender, StopsWhenToldTo) {
  const ScratchFolder folder;
  const World world(random_scene(1));
  const RenderSettings s = small();
  const std::function<bool()> at_once = [] { return true; };
  CollectingRender maps(world, s, kinds_of_scenes());
  EXPECT_FALSE(maps.render_tile(0, all_passes, at_once));
  {
    CloudFile file(folder / "a.ply", {});
    CollectingRender cloud(world, s, {});
    cloud.also_collect(file);
    EXPECT_FALSE(cloud.render_tile(3, all_passes, at_once));
  }
  EXPECT_EQ(folder.file_count(), 0u);
}

}  // namespace
}  // namespace rayfarm
