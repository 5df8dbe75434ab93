// The renderer's laws: samples are pure functions, scale does not matter, what is not finite is counted.
#include "common/render/render.h"

#include <gtest/gtest.h>

#include <cstring>
#include <thread>

#include "common/render/probe.h"
#include "tests/support/mirror_hall.h"
#include "tests/support/moved_scene.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

RenderSettings small_settings() {
  RenderSettings s;
  s.width = 70, s.height = 66, s.spp = 4, s.max_depth = 5;
  return s;
}

const auto never = [] { return false; };

Film rendered(const World& world, const RenderSettings& s, PassSet first = all_passes) {
  Film film({s.width, s.height});
  for (std::uint32_t tile = 0; tile < tile_count(film.size()); ++tile)
    for (const PassSet passes : {first, static_cast<PassSet>(all_passes & ~first)}) {
      if (passes == 0) continue;
      const std::optional<std::vector<PassImage>> images = render_tile(world, s, tile, passes, never);
      for (const PassImage& image : *images) film.put(tile, image);
    }
  return film;
}

bool same_bits(const Film& a, const Film& b) {
  return a.rgb().size() == b.rgb().size() &&
         std::memcmp(a.rgb().data(), b.rgb().data(), a.rgb().size() * sizeof(float)) == 0;
}

TEST(Render, PassesAndThreadsDoNotChangeABit) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Scene (*const make)(std::uint64_t) = seed < 5 ? random_scene : random_special_scene;
    const World world(make(seed));
    RenderSettings s = small_settings();
    if (seed == 4 || seed == 7) s.sampler = SamplerKind::adapt1, s.spp = 16;
    const Film whole = rendered(world, s);
    EXPECT_TRUE(whole.is_complete());
    EXPECT_TRUE(same_bits(whole, rendered(world, s, 0b0101)));
    Film other;
    std::thread([&] { other = rendered(World(make(seed)), s, 0b0010); }).join();
    EXPECT_TRUE(same_bits(whole, other));
  }
}

TEST(Render, CountersOfPassesAddUpToThoseOfTheTile) {
  const World world(random_scene(3));
  const RenderSettings s = small_settings();
  const auto sum = [&](std::initializer_list<PassSet> parts) {
    RayCounters total;
    for (const PassSet passes : parts) {
      const auto images = render_tile(world, s, 0, passes, never);
      for (const PassImage& image : *images) total += image.counters;
    }
    return total;
  };
  EXPECT_EQ(sum({all_passes}), sum({0b0001, 0b0010, 0b0100, 0b1000}));
  EXPECT_EQ(sum({all_passes}).primary, 64u * 64 * s.spp);
}

TEST(Render, PiecesOfATileAreTheTile) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const World world(seed < 4 ? random_scene(seed) : random_special_scene(seed));
    RenderSettings s = small_settings();
    if (seed % 2 == 1) s.sampler = SamplerKind::adapt1, s.spp = 16;
    const Film whole = rendered(world, s);
    for (const std::uint32_t side : {16u, 32u}) {
      RayCounters sum;
      for (std::uint32_t y = 0; y < 64; y += side)
        for (std::uint32_t x = 0; x < 64; x += side) {
          const Tile piece{x, y, x + side, y + side};
          const auto images = render_area(world, s, piece, all_passes, never);
          for (const PassImage& image : *images) {
            EXPECT_EQ(image.rgb, whole.pass_pixels(piece, image.pass));
            sum += image.counters;
          }
        }
      RayCounters of_tile;
      const auto images = render_tile(world, s, 0, all_passes, never);
      for (const PassImage& image : *images) of_tile += image.counters;
      EXPECT_EQ(sum, of_tile);
    }
  }
}

TEST(Render, AStopIsHeardInMidPixelAndDropsTheTile) {
  const World world(random_scene(3));
  RenderSettings s = small_settings();
  s.spp = 100'000;  // one pixel alone would take long
  int questions = 0;
  EXPECT_EQ(render_tile(world, s, 0, all_passes, [&] { return ++questions > 3; }), std::nullopt);
  EXPECT_EQ(questions, 4);
}

TEST(Render, AStopIsHeardInMidSample) {
  RenderSettings s = small_settings();
  s.spp = 1, s.max_depth = 90, s.min_importance = 0;
  int questions = 0;
  EXPECT_EQ(render_tile(World(mirror_hall()), s, 0, all_passes, [&] { return ++questions > 10; }),
            std::nullopt);
  EXPECT_EQ(questions, 11);
}

TEST(Render, AllLengthsTimesAPowerOfTwoGiveTheSameBits) {
  // No length is called small or large by itself.
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RenderSettings s = small_settings();
    s.spp = 1;
    for (Scene (*make)(std::uint64_t) :
         {random_scene, random_snapped_scene, random_special_scene, random_faceted_scene}) {
      const Scene scene = make(seed);
      const Film here = rendered(World(scene), s);
      for (const int k : {-20, -7, 3, 20})
        EXPECT_TRUE(same_bits(here, rendered(World(scaled(scene, k)), s))) << seed << " * 2^" << k;
    }
  }
}

TEST(Render, WhereTheCameraHasNoRayTheFilmIsBlackAndNothingIsCounted) {
  Scene scene = random_scene(6);
  scene.background = {1, 1, 1};
  scene.camera = FisheyeCamera{.from = {0, 0, -7}};
  RenderSettings s = small_settings();
  s.width = s.height = 64, s.spp = 1;
  RayCounters total;
  const World world(scene);
  const auto images = render_tile(world, s, 0, all_passes, never);
  for (const PassImage& image : *images) total += image.counters;
  EXPECT_NEAR(static_cast<double>(total.primary), 64 * 64 * 3.1416 / 4, 20);
  const Probe corner = probe(world, s, 1, 1, {0, 0});
  EXPECT_FALSE(corner.first_hit);
  EXPECT_EQ(corner.color, glm::dvec3(0.0));
}

TEST(Render, WhatIsNotFiniteIsBlackAndCounted) {
  Scene scene;
  scene.nodes = {{Sphere{}, {}, {}, {}, {}, {}}};
  scene.camera = PerspectiveCamera{{0, 0, -5}, {0, 0, 1}, {0, 1, 0}, 10};
  scene.lights = {AmbientLight{glm::dvec3(1e300)}};  // no float
  RenderSettings s = small_settings();
  const World world(scene);
  const auto images = render_tile(world, s, 0, all_passes, never);
  RayCounters total;
  for (const PassImage& image : *images) {
    total += image.counters;
    for (const float value : image.rgb) ASSERT_EQ(value, 0.0f);
  }
  EXPECT_EQ(total.bad_samples, total.primary);
}

TEST(Render, EffectsCanBeSwitchedOff) {
  const World world(random_scene(4));
  RenderSettings s = small_settings();
  s.shadows = s.reflections = s.refractions = false;
  const auto images = render_tile(world, s, 0, all_passes, never);
  RayCounters total;
  for (const PassImage& image : *images) total += image.counters;
  EXPECT_EQ(total.rays(), total.primary);
  EXPECT_GT(total.primary_hits, 0u);
}

TEST(Render, ACamerasDirectionMayHaveAnyLength) {
  Scene scene = random_scene(5);
  const RenderSettings s = small_settings();
  auto& camera = std::get<PerspectiveCamera>(scene.camera);
  const PerspectiveCamera as_it_was = camera;
  const glm::dvec3 color = probe(World(scene), s, 30, 30, {0, 0}).color;
  for (const double length : {1e-200, 1e200}) {
    camera.direction = as_it_was.direction * length, camera.up = as_it_was.up * length;
    EXPECT_LT(glm::length(probe(World(scene), s, 30, 30, {0, 0}).color - color), 1e-9);
  }
}

TEST(Render, ACameraInsideGlassSeesOut) {
  // Index 1 and full transmission: the ball bends nothing and the background is seen through it.
  Scene scene;
  Material clear;
  clear.ambient = clear.diffuse = clear.specular = clear.schlick = 0, clear.transmission = 1, clear.index = 1;
  scene.materials = {clear};
  scene.nodes = {{Sphere{}, {}, 0u, {}, {}, {}}};
  scene.background = {0.25, 0.5, 0.75};
  scene.lights = {AmbientLight{}};
  const RenderSettings s = small_settings();
  for (const double z : {-5.0, 0.0, 0.5}) {
    scene.camera = PerspectiveCamera{{0.1, 0.2, z}, {0, 0, 1}, {0, 1, 0}, 40};
    const glm::dvec3 color = probe(World(scene), s, 35, 33, {0, 0}).color;
    EXPECT_NEAR(color.x, 0.25, 1e-12);
    EXPECT_NEAR(color.z, 0.75, 1e-12);
  }
}

}  // namespace
}  // namespace rayfarm
