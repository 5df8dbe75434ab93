#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "common/render/sampler.h"

namespace rayfarm {
namespace {

RenderSettings settings_for(SamplerKind kind, std::uint32_t spp) {
  RenderSettings s;
  s.sampler = kind, s.spp = spp;
  return s;
}

std::vector<SamplerKind> all_kinds() {
  return {SamplerKind::sobol, SamplerKind::jitter, SamplerKind::regular, SamplerKind::random,
          SamplerKind::adapt1};
}

TEST(Sampler, SamplesLieInTheUnitSquareAndAreAFunctionOfTheirKeys) {
  for (const SamplerKind kind : all_kinds()) {
    const RenderSettings s = settings_for(kind, 64);
    for (std::uint32_t pixel = 0; pixel < 100; ++pixel)
      for (std::uint32_t i = 0; i < 64; ++i)
        for (std::uint32_t pair = 0; pair < 3; ++pair) {
          const Sample2D a = PixelSampler(s, {pixel, 7}).sample(i, pair);
          const Sample2D b = PixelSampler(s, {pixel, 7}).sample(i, pair);
          ASSERT_TRUE(a.u >= 0 && a.u < 1 && a.v >= 0 && a.v < 1);
          ASSERT_TRUE(a.u == b.u && a.v == b.v);
        }
  }
}

/// How many of the nx x ny cells hold exactly one sample.
std::size_t cells_hit(const RenderSettings& s, Pixel pixel, std::uint32_t pair, std::uint32_t nx,
                      std::uint32_t ny) {
  std::set<std::uint32_t> cells;
  const PixelSampler sampler(s, pixel);
  for (std::uint32_t i = 0; i < s.spp; ++i) {
    const Sample2D at = sampler.sample(i, pair);
    cells.insert(static_cast<std::uint32_t>(at.u * nx) + nx * static_cast<std::uint32_t>(at.v * ny));
  }
  return cells.size();
}

TEST(Sampler, SobolIsAZeroTwoNetOnPixelAndLights) {
  // A (0,m,2)-net in base 2: every elementary box of area 1/n holds exactly one of n points.
  const RenderSettings s = settings_for(SamplerKind::sobol, 64);
  for (std::uint32_t x = 0; x < 20; ++x)
    for (std::uint32_t pair = 0; pair < 3; ++pair)
      for (std::uint32_t nx = 1; nx <= 64; nx *= 2)
        ASSERT_EQ(cells_hit(s, {x, 3}, pair, nx, 64 / nx), 64u) << nx << " pair " << pair;
}

TEST(Sampler, JitterAndRegularFillEachCellOnce) {
  for (const SamplerKind kind : {SamplerKind::jitter, SamplerKind::regular})
    for (std::uint32_t pair = 0; pair < 3; ++pair)
      EXPECT_EQ(cells_hit(settings_for(kind, 49), {5, 6}, pair, 7, 7), 49u);
}

TEST(Sampler, SeedFramePixelAndPairChangeTheSamples) {
  for (const SamplerKind kind :
       {SamplerKind::sobol, SamplerKind::jitter, SamplerKind::random, SamplerKind::adapt1}) {
    RenderSettings s = settings_for(kind, 16);
    const double here = PixelSampler(s, {1, 2}).sample(3, 0).u;
    EXPECT_NE(here, PixelSampler(s, {2, 1}).sample(3, 0).u);
    EXPECT_NE(here, PixelSampler(s, {1, 2}).sample(3, 1).u);
    s.frame = 1;
    EXPECT_NE(here, PixelSampler(s, {1, 2}).sample(3, 0).u);
    s.frame = 0, s.seed = 1;
    EXPECT_NE(here, PixelSampler(s, {1, 2}).sample(3, 0).u);
  }
}

/// Root mean square error of the mean of f over many pixels.
template <class F>
double error_of_mean(SamplerKind kind, std::uint32_t spp, double exact, F f) {
  const RenderSettings s = settings_for(kind, spp);
  double squares = 0;
  constexpr std::uint32_t trials = 1'500;
  for (std::uint32_t x = 0; x < trials; ++x) {
    const PixelSampler sampler(s, {x, 0});
    double sum = 0;
    for (std::uint32_t i = 0; i < spp; ++i) sum += f(sampler.sample(i, 0), x);
    squares += (sum / spp - exact) * (sum / spp - exact);
  }
  return std::sqrt(squares / trials);
}

TEST(Sampler, TheErrorFallsAsTheTheorySays) {
  // Slopes of RMSE over n for a smooth integrand: -1/2 at random, -1 jittered, near -3/2 for Owen-scrambled
  // nets.
  const auto smooth = [](const Sample2D& s, std::uint32_t) { return std::exp(s.u + s.v); };
  const double exact = (std::exp(1) - 1) * (std::exp(1) - 1);
  const auto slope = [&](SamplerKind kind) {
    return std::log(error_of_mean(kind, 1024, exact, smooth) / error_of_mean(kind, 16, exact, smooth)) /
           std::log(64);
  };
  EXPECT_NEAR(slope(SamplerKind::random), -0.5, 0.05);
  EXPECT_NEAR(slope(SamplerKind::jitter), -1.0, 0.05);
  EXPECT_LT(slope(SamplerKind::sobol), -1.35);
}

}  // namespace
}  // namespace rayfarm
