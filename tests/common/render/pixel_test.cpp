// A pixel's samples, as everybody visits them.
#include "common/render/pixel.h"

#include <gtest/gtest.h>

#include "common/render/render.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

constexpr auto all_kinds = {SamplerKind::sobol, SamplerKind::jitter, SamplerKind::regular,
                            SamplerKind::random, SamplerKind::adapt1};
const auto never = [] { return false; };

RenderSettings settings_for(SamplerKind kind) {
  RenderSettings s;
  s.width = 70, s.height = 66, s.spp = 16, s.max_depth = 4, s.sampler = kind;
  return s;
}

std::vector<TakenSample> samples_of(const World& world, const RenderSettings& s, Pixel pixel) {
  Tracer<CountingObserver> tracer(world, s);
  std::vector<TakenSample> samples;
  visit_samples(tracer, s, pixel, never, [&](const TakenSample& sample) { samples.push_back(sample); });
  EXPECT_EQ(tracer.observer.counters.primary, samples.size());
  return samples;
}

TEST(PixelSamples, WeighAsMuchAsThePixelAndAreNumberedInTheirOrder) {
  const World world(random_scene(3));
  for (const SamplerKind kind : all_kinds)
    for (std::uint32_t x = 0; x < 70; ++x) {
      const RenderSettings s = settings_for(kind);
      std::uint32_t weight = 0, number = 0;
      for (const TakenSample& sample : samples_of(world, s, {x, 30})) {
        EXPECT_EQ(sample.number, number++);
        EXPECT_TRUE(sample.at.u >= 0 && sample.at.u < 1 && sample.at.v >= 0 && sample.at.v < 1);
        weight += sample.weight;
      }
      EXPECT_EQ(weight, pixel_weight(s));
    }
}

TEST(PixelSamples, AreThoseOfTheRenderedPixel) {
  for (const SamplerKind kind : all_kinds)
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      const World world(random_scene(seed));
      const RenderSettings s = settings_for(kind);
      const PassImage coarse = render_tile(world, s, 0, 0b0001, never)->front();
      std::size_t at = 0;
      for_each_pixel(tile_at({s.width, s.height}, 0), 0, [&](std::uint32_t x, std::uint32_t y) {
        Vec3d sum{};
        for (const TakenSample& sample : samples_of(world, s, {x, y}))
          sum += sample.color * static_cast<double>(sample.weight);
        for (int c = 0; c < 3; ++c)
          ASSERT_EQ(coarse.rgb[at++], static_cast<float>(sum[c] / pixel_weight(s))) << x << "," << y;
      });
    }
}

TEST(PixelSamples, OfAnAdaptiveSamplerAreMoreWhereMoreIsToBeSeen) {
  const World world(random_scene(3));
  RenderSettings s = settings_for(SamplerKind::adapt1);
  s.spp = 64;
  std::uint64_t samples = 0, least = 64, most = 0;
  for (std::uint32_t x = 0; x < s.width; ++x)
    for (std::uint32_t y = 0; y < s.height; ++y) {
      const std::uint64_t here = samples_of(world, s, {x, y}).size();
      samples += here, least = std::min(least, here), most = std::max(most, here);
    }
  EXPECT_EQ(least, 4u);
  EXPECT_GT(most, 30u);
  RayCounters counted;
  for (std::uint32_t tile = 0; tile < tile_count({s.width, s.height}); ++tile) {
    const auto images = render_tile(world, s, tile, all_passes, never);
    for (const PassImage& image : *images) counted += image.counters;
  }
  EXPECT_EQ(counted.primary, samples);
}

TEST(PixelSamples, AreOfNoUseAfterAStop) {
  const World world(random_scene(3));
  for (const SamplerKind kind : all_kinds) {
    RenderSettings s = settings_for(kind);
    s.spp = 512 * 512;
    Tracer<CountingObserver> tracer(world, s);
    bool complete = true;
    for (std::uint32_t x = 0; x < s.width && complete; ++x)
      complete = visit_samples(
          tracer, s, {x, 30}, [] { return true; }, [](const TakenSample&) {});
    EXPECT_FALSE(complete);
    EXPECT_LT(tracer.observer.counters.primary, 2'000u);
  }
}

}  // namespace
}  // namespace rayfarm
