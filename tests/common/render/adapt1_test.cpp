#include "common/render/adapt1.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "common/math/hash.h"

namespace rayfarm::adapt1 {
namespace {

/// The samples of one pixel that shows `content`(place) -> Seen.
template <class Content>
std::vector<Sample> samples_of(Pixel pixel, std::uint32_t spp, Content content) {
  RenderSettings s;
  s.sampler = SamplerKind::adapt1, s.spp = spp;
  const PixelSampler sampler(s, pixel);
  const Quadtree tree(sampler, spp, [&](std::uint32_t, const Sample2D& at) { return content(at); });
  return tree.samples();
}

Seen grey(double value) { return {{value, value, value}, 0}; }

/// An edge somewhere across the pixel.
auto edge(std::uint32_t number) {
  const double slope = number % 7 * 0.3 - 1, middle = number % 11 / 10.0;
  return [=](const Sample2D& at) { return grey(at.u + slope * (at.v - 0.5) > middle ? 1 : 0); };
}

TEST(Adapt1, APixelThatIsAllAlikeTakesFourSamplesOneInEachQuarter) {
  for (const std::uint32_t spp : {4u, 9u, 64u, 1024u})
    for (std::uint32_t x = 0; x < 50; ++x) {
      const auto samples = samples_of({x, 3}, spp, [](const Sample2D&) { return grey(0.5); });
      ASSERT_EQ(samples.size(), 4u);
      std::set<int> quarters;
      for (const Sample& s : samples) {
        quarters.insert((s.at.u < 0.5 ? 0 : 1) + (s.at.v < 0.5 ? 0 : 2));
        EXPECT_EQ(4 * s.weight, smallest_cells(spp));
      }
      EXPECT_EQ(quarters.size(), 4u);
    }
}

TEST(Adapt1, OneSampleAsksForNoMore) {
  const auto samples = samples_of({1, 2}, 1, [](const Sample2D&) { return grey(0); });
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].weight, 1u);
}

TEST(Adapt1, TheWeightsAreTheAreasOfCellsThatFillThePixel) {
  for (const std::uint32_t spp : {4u, 9u, 16u, 64u, 256u})
    for (std::uint32_t x = 0; x < 200; ++x) {
      std::uint64_t cells = 0;
      std::set<std::pair<std::uint32_t, std::uint32_t>> squares;  // the corners of those that hold a sample
      for (const Sample& s : samples_of({x, 5}, spp, edge(x))) {
        cells += s.weight;
        std::uint32_t side = 1;  // of the sample's cell, in smallest cells
        while (side * side < s.weight) side *= 2;
        ASSERT_EQ(side * side, s.weight);
        const std::uint32_t across = (1u << depth(spp)) / side;
        squares.insert({static_cast<std::uint32_t>(s.at.u * across) * side,
                        static_cast<std::uint32_t>(s.at.v * across) * side});
      }
      EXPECT_EQ(cells, smallest_cells(spp));
      EXPECT_EQ(squares.size(), samples_of({x, 5}, spp, edge(x)).size());
    }
}

TEST(Adapt1, AGradientIsDividedToTheEnd) {
  const auto gradient = [](const Sample2D& at) { return grey(1e6 * (at.u + 2 * at.v)); };
  EXPECT_EQ(samples_of({8, 9}, 64, gradient).size(), 64u);
  EXPECT_EQ(samples_of({8, 9}, 9, gradient).size(), 16u);  // n = 3 goes as deep as n = 4
}

TEST(Adapt1, AnEdgeTakesTheSamplesThatItIsKnownToTake) {
  // 21.6 with n = 8 and 37.0 with n = 16 were found for edges through a random point in a random direction, by an
  // independent program.
  for (const auto& [spp, known] : {std::pair{64u, 21.6}, {256u, 37.0}}) {
    constexpr std::uint32_t trials = 20'000;
    std::uint64_t taken = 0;
    for (std::uint32_t x = 0; x < trials; ++x) {
      const std::uint64_t key = keyed(17, x);
      const double angle = 6.283185307179586 * unit_interval(keyed(key, 0));
      const double u = unit_interval(keyed(key, 1)), v = unit_interval(keyed(key, 2));
      taken += samples_of({x, 0}, spp, [&](const Sample2D& at) {
                 return grey((at.u - u) * std::cos(angle) + (at.v - v) * std::sin(angle) > 0 ? 1 : 0);
               }).size();
    }
    EXPECT_NEAR(static_cast<double>(taken) / trials, known, 0.02 * known);
  }
}

TEST(Adapt1, ADifferentSignatureDividesWhereTheColourIsTheSame) {
  const auto signed_halves = [](const Sample2D& at) { return Seen{{}, at.u < 0.3 ? 1u : 2u}; };
  EXPECT_GT(samples_of({1, 1}, 64, signed_halves).size(), 4u);
}

TEST(Adapt1, ColoursNearerThanTheThresholdAreTheSame) {
  for (const auto& [step, divides] : {std::pair{0.99 * threshold, false}, {1.01 * threshold, true}}) {
    const auto red_step = [step = step](const Sample2D& at) {
      return Seen{{at.u < 0.5 ? 0 : step, 0, 0}, 0};
    };
    EXPECT_EQ(samples_of({4, 4}, 16, red_step).size() > 4, divides) << step;
  }
}

}  // namespace
}  // namespace rayfarm::adapt1
