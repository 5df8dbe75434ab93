#include "master/diagnostics/pixel_trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/render/render.h"
#include "master/diagnostics/leaf_names.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

constexpr std::uint32_t side = 24;

RenderSettings small_settings() {
  RenderSettings s;
  s.width = s.height = side, s.spp = 4;
  return s;
}

/// Calls visit(world, settings, pixel, trees of its samples) for the pixels of some random scenes.
template <class Visit>
void for_each_traced_pixel(Visit&& visit) {
  const RenderSettings s = small_settings();
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    constexpr Scene (*makes[])(std::uint64_t){random_scene, random_snapped_scene, random_special_scene};
    const World world(makes[seed % 3](seed));
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x) {
        std::vector<RayRecord> rays;
        for (TracedSample& sample : traced_samples(world, s, {x, y}, EverySample{}).samples)
          rays.push_back(std::move(sample.ray));
        visit(world, s, Pixel{x, y}, rays);
      }
  }
}

template <class Visit>
void for_each_ray(const RayRecord& ray, Visit&& visit) {
  visit(ray);
  for (const RayRecord& followed : ray.followed) for_each_ray(followed, visit);
}

TEST(RayTree, TheMeanOfThePixelsSamplesIsTheRenderedPixelBitForBit) {
  const RenderSettings s = small_settings();
  const World* rendered = nullptr;
  Film film;
  for_each_traced_pixel([&](const World& world, const RenderSettings&, Pixel p, const auto& rays) {
    if (p == Pixel{0, 0}) {
      rendered = &world;
      film = Film({side, side});
      const auto images = render_tile(world, s, 0, all_passes, [] { return false; });
      for (const PassImage& image : *images) film.put(0, image);
    }
    ASSERT_EQ(rendered, &world);
    PixelSum sum;
    for (const RayRecord& ray : rays) sum.add(ray.color, 1);
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_EQ(sum.mean(s.spp)[c], film.rgb()[3 * (p.y * side + p.x) + c]) << p.x << "," << p.y;
  });
}

TEST(RayTree, HoldsTheRaysThatTheRenderCounts) {
  RayCounters recorded;
  for_each_traced_pixel([&](const World& world, const RenderSettings& s, Pixel p, const auto& rays) {
    if (p == Pixel{0, 0}) recorded = {};
    for (const RayRecord& root : rays)
      for_each_ray(root, [&](const RayRecord& ray) {
        recorded.primary += ray.kind == RayKind::primary;
        recorded.reflected += ray.kind == RayKind::reflected;
        recorded.refracted += ray.kind == RayKind::refracted;
        (ray.kind == RayKind::primary ? recorded.primary_hits : recorded.secondary_hits) +=
            ray.hit.has_value();
        for (const LightAtHit& light : ray.lights)
          recorded.shadow += light.fate == LightFate::reached || light.fate == LightFate::blocked;
      });
    if (p != Pixel{side - 1, side - 1}) return;
    RayCounters counted;
    const auto images = render_tile(world, s, 0, all_passes, [] { return false; });
    for (const PassImage& image : *images) counted += image.counters;
    counted.bad_samples = 0;
    EXPECT_EQ(recorded, counted);
  });
}

TEST(RayTree, ARaysColorIsItsLightsAndTheWeighedColorsOfWhatItFollows) {
  for_each_traced_pixel([&](const World&, const RenderSettings&, Pixel, const auto& rays) {
    for (const RayRecord& root : rays)
      for_each_ray(root, [&](const RayRecord& ray) {
        if (!ray.hit || ray.lights.empty()) return;
        Vec3d sum;
        for (const LightAtHit& light : ray.lights) sum += light.color;
        for (const RayRecord& followed : ray.followed) {
          ASSERT_EQ(followed.importance, ray.importance * followed.weight);
          sum += followed.color * followed.weight;
        }
        for (const GlowOnRay& glow : ray.glows) sum += glow.color;
        ASSERT_EQ(sum, ray.color);
      });
  });
}

TEST(RayTree, WhatBlocksALightStandsBeforeIt) {
  int blocked = 0;
  for_each_traced_pixel([&](const World&, const RenderSettings&, Pixel, const auto& rays) {
    for (const RayRecord& root : rays)
      for_each_ray(root, [&](const RayRecord& ray) {
        for (const LightAtHit& light : ray.lights) {
          ASSERT_TRUE(light.fate == LightFate::blocked || !light.blocker);
          if (!light.blocker) continue;
          ++blocked;
          const double to_light = length(light.at - ray.hit->point);
          const double to_blocker = length(light.blocker->point - ray.hit->point);
          ASSERT_LE(to_blocker, to_light * (1 + 1e-9));
        }
      });
  });
  EXPECT_GT(blocked, 100);
}

/// Flat: how many rays, those to the lights too.
std::size_t rays_in(const std::vector<TracedSample>& samples) {
  std::size_t rays = 0;
  for (const TracedSample& sample : samples)
    for_each_ray(sample.ray, [&](const RayRecord& ray) {
      ++rays;
      for (const LightAtHit& light : ray.lights)
        rays += light.fate == LightFate::reached || light.fate == LightFate::blocked;
    });
  return rays;
}

/// The records of a are the first of b's.
void expect_beginning(const RayRecord& a, const RayRecord& b) {
  EXPECT_EQ(a.path.origin, b.path.origin);
  EXPECT_EQ(a.path.direction, b.path.direction);
  EXPECT_EQ(a.hit.has_value(), b.hit.has_value());
  ASSERT_LE(a.lights.size(), b.lights.size());
  ASSERT_LE(a.followed.size(), b.followed.size());
  for (std::size_t i = 0; i < a.followed.size(); ++i) expect_beginning(a.followed[i], b.followed[i]);
}

TEST(RayTree, OneSampleIsTheSameAsAmongAll) {
  for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::adapt1}) {
    RenderSettings s = small_settings();
    s.sampler = sampler;
    const World world(random_scene(3));
    const auto all = traced_samples(world, s, {11, 12}, EverySample{}).samples;
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      const auto one = traced_samples(world, s, {11, 12}, i).samples;
      ASSERT_EQ(one.size(), 1u);
      EXPECT_EQ(one[0].number, i);
      EXPECT_EQ(std::pair(one[0].x, one[0].y), std::pair(all[i].x, all[i].y));
      EXPECT_EQ(one[0].ray.color, all[i].ray.color);
      EXPECT_EQ(rays_in(one), rays_in({all[i]}));
    }
  }
}

TEST(RayTree, SamplesForWhichTheCameraHasNoRayAreLeftOut) {
  Scene scene = random_scene(3);
  scene.camera = FisheyeCamera{};
  const World world(scene);
  for (const SamplerKind sampler : {SamplerKind::sobol, SamplerKind::adapt1}) {
    RenderSettings s = small_settings();
    s.sampler = sampler;
    EXPECT_TRUE(traced_samples(world, s, {0, 0}, EverySample{}).samples.empty());
    EXPECT_TRUE(traced_samples(world, s, {0, 0}, 1u).samples.empty());
    EXPECT_TRUE(traced_samples(world, s, {0, 0}, PixelCentre{}).samples.empty());
    std::size_t at_the_edge = 0;
    for (std::uint32_t i = 0; i < side; ++i)
      for (const TracedSample& one : traced_samples(world, s, {i, 3}, EverySample{}).samples) {
        ++at_the_edge;
        const auto same = traced_samples(world, s, {i, 3}, *one.number).samples;
        ASSERT_EQ(same.size(), 1u);
        EXPECT_EQ(same[0].ray.path.direction, one.ray.path.direction);
      }
    EXPECT_GT(at_the_edge, 0u);
  }
}

TEST(RayTree, AdaptiveSamplesHaveTheWeightsOfTheRenderedPixel) {
  RenderSettings s = small_settings();
  s.sampler = SamplerKind::adapt1, s.spp = 16;
  const World world(random_scene(3));
  Film film({side, side});
  const auto images = render_tile(world, s, 0, all_passes, [] { return false; });
  for (const PassImage& image : *images) film.put(0, image);
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      PixelSum sum;
      for (const TracedSample& sample : traced_samples(world, s, {x, y}, EverySample{}).samples)
        sum.add(sample.ray.color, sample.weight);
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_EQ(sum.mean(pixel_weight(s))[c], film.rgb()[3 * (y * side + x) + c]) << x << "," << y;
    }
}

TEST(RayTree, IsCutAtTheLimitAndSaysSo) {
  const RenderSettings s = small_settings();
  const World world(random_scene(3));
  for (std::uint32_t x = 0; x < side; ++x) {
    const TracedSamples whole = traced_samples(world, s, {x, 12}, EverySample{});
    EXPECT_FALSE(whole.truncated);
    const std::size_t rays = rays_in(whole.samples);
    for (std::size_t limit = 0; limit <= rays; ++limit) {
      const TracedSamples cut = traced_samples(world, s, {x, 12}, EverySample{}, {.rays = limit});
      EXPECT_EQ(cut.truncated, limit < rays);
      ASSERT_LE(rays_in(cut.samples), limit);
      ASSERT_LE(cut.samples.size(), whole.samples.size());
      for (std::size_t i = 0; i < cut.samples.size(); ++i)
        expect_beginning(cut.samples[i].ray, whole.samples[i].ray);
    }
  }
}

TEST(RayTree, AStopIsHeardInTheMiddleOfASample) {
  Scene scene = random_scene(3);
  for (Material& material : scene.materials) material.transmission = material.specular = 1;
  RenderSettings s = small_settings();
  s.max_depth = 100, s.min_importance = 0;
  const World world(scene);
  int questions = 0;
  std::size_t rays = 0;
  for (std::uint32_t x = 0; x < side; ++x) {
    const TracedSamples cut =
        traced_samples(world, s, {x, 12}, 0u, {.stop = [&] { return ++questions > 3; }});
    rays = std::max(rays, rays_in(cut.samples));
  }
  EXPECT_GT(questions, 3) << "else the scene is too simple";
  EXPECT_LT(rays, 100'000u);
}

template <class Call>
std::string complaint(Call&& call) {
  try {
    call();
  } catch (const SettingsError& error) {
    return error.what();
  }
  return "none";
}

TEST(RayTree, WhatThePictureHasNotGotIsNamed) {
  const RenderSettings s = small_settings();
  const World world(random_scene(3));
  EXPECT_NE(complaint([&] {
              traced_samples(world, s, {side, 0}, EverySample{});
            }).find("23,23"),
            std::string::npos);
  EXPECT_NE(complaint([&] { traced_samples(world, s, {0, 0}, 4u); }).find("from 0 to 3"), std::string::npos);
  for (const char* text : {"4", "-1", "", "1x", "some"})
    EXPECT_NE(complaint([&] { sample_choice(text, s); }).find("from 0 to 3"), std::string::npos) << text;
  EXPECT_EQ(std::get<std::uint32_t>(sample_choice("3", s)), 3u);
}

TEST(CsgStory, TheMaterialBeginsOrEndsWhereThePrimaryRayHits) {
  int hits = 0;
  for_each_traced_pixel([&](const World& world, const RenderSettings&, Pixel, const auto& rays) {
    if (rays.empty()) return;
    const RayRecord& ray = rays[0];
    const CsgStory story = csg_story(world, ray.path);
    if (!ray.hit) return;
    ++hits;
    ASSERT_FALSE(story.material.empty());
    const Stretch& first = story.material[0];
    ASSERT_NEAR(ray.hit->entering ? first.in : first.out, ray.hit->distance, 1e-12 * ray.hit->distance);
    ASSERT_TRUE(std::any_of(story.leaves.begin(), story.leaves.end(),
                            [&](const LeafStretches& leaf) { return leaf.leaf == ray.hit->leaf; }));
  });
  EXPECT_GT(hits, 100);
}

TEST(CsgStory, ABallWithAHole) {
  Scene scene;
  scene.nodes = {{Operation{CsgOp::subtract, 2}, {}, {}, {}, {}, {}},
                 {Sphere{}, {}, {}, {}, {}, "ball"},
                 {Sphere{}, scaling({0.5, 0.5, 0.5}), {}, {}, {}, "hole"}};
  const CsgStory story = csg_story(World(scene), {{0, 0, -5}, {0, 0, 1}});
  ASSERT_EQ(story.leaves.size(), 2u);
  EXPECT_EQ(story.leaves[0].stretches, (std::vector<Stretch>{{4, 6}}));
  EXPECT_EQ(story.leaves[1].stretches, (std::vector<Stretch>{{4.5, 5.5}}));
  EXPECT_EQ(story.material, (std::vector<Stretch>{{4, 4.5}, {5.5, 6}}));
}

TEST(CsgStory, SaysWhatIsTakenAway) {
  // a - (b - c): c is given back.
  Scene scene;
  scene.nodes = {{Operation{CsgOp::subtract, 2}, {}, {}, {}, {}, {}},
                 {Sphere{}, {}, {}, {}, {}, "a"},
                 {Operation{CsgOp::subtract, 2}, {}, {}, {}, {}, {}},
                 {Sphere{}, scaling({0.5, 0.5, 0.5}), {}, {}, {}, "b"},
                 {Sphere{}, scaling({0.25, 0.25, 0.25}), {}, {}, {}, "c"}};
  const CsgStory story = csg_story(World(scene), {{0, 0, -5}, {0, 0, 1}});
  ASSERT_EQ(story.leaves.size(), 3u);
  EXPECT_FALSE(story.leaves[0].is_subtracted);
  EXPECT_TRUE(story.leaves[1].is_subtracted);
  EXPECT_FALSE(story.leaves[2].is_subtracted);
}

/// A mirror ball above a matte floor that it shadows.
PixelTrace trace_of_a_ball(const SampleChoice& choice = EverySample{}, std::uint32_t story_ray = 0) {
  Scene scene;
  Material mirror;
  mirror.specular = 0.9, mirror.diffuse = mirror.ambient = 0.05;
  scene.materials = {mirror};
  scene.nodes = {{Operation{CsgOp::unite, 2}, {}, {}, {}, {}, {}},
                 {Sphere{}, {}, 0u, {}, {}, "b<a>ll"},
                 {Plane{}, Affine{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {0, -1, 0}}, {}, {}, {}, "floor"}};
  scene.camera = PerspectiveCamera{{0, 1, -6}, {0, -0.2, 1}, {0, 1, 0}, 40};
  scene.lights = {AmbientLight{}, PointLight{{0, 9, -1}}};
  const World world(scene);
  const RenderSettings s = small_settings();
  const auto names = std::make_shared<std::vector<std::string>>(leaf_names(scene));
  return pixel_trace(world, names, s, {side / 2, side / 2}, choice, story_ray);
}

TEST(PixelTrace, TellsTheStoryOfAnyRayOfASample) {
  const PixelTrace trace = trace_of_a_ball(2u, 1);
  ASSERT_EQ(trace.samples.size(), 1u);
  const RayRecord& mirrored = trace.samples[0].traced.ray.followed.at(0);
  const CsgStory& story = trace.samples[0].story;
  ASSERT_TRUE(mirrored.hit);  // on the floor, from the ball's surface, which it is not inside
  ASSERT_EQ(story.leaves.size(), 1u);
  EXPECT_EQ(story.leaves[0].leaf, mirrored.hit->leaf);
  EXPECT_NEAR(story.material.at(0).in, mirrored.hit->distance, 1e-12 * mirrored.hit->distance);
  EXPECT_EQ(to_json(trace)["samples"][0]["csg"]["ray"], 1);
  EXPECT_NE(text_of(trace).find("along ray 1"), std::string::npos);

  EXPECT_NE(complaint([] { trace_of_a_ball(2u, 99); }).find("there is no ray 99"), std::string::npos);
  EXPECT_NE(complaint([] { trace_of_a_ball(EverySample{}, 1); }).find("name the sample"), std::string::npos);
}

TEST(PixelTrace, WhatLightsAddIsPartOfWhatTheirRayAdds) {
  const nlohmann::json ray = to_json(trace_of_a_ball(2u))["samples"][0]["ray"]["rays"][0];
  double sum = 0;
  for (const auto& light : ray["lights"]) sum += light["contribution"][0].get<double>();
  for (const auto& followed : ray["rays"]) sum += followed["contribution"][0].get<double>();
  EXPECT_GT(sum, 0);
  EXPECT_LT(ray["importance"], 1);
  EXPECT_NEAR(sum, ray["contribution"][0].get<double>(), 1e-15);
}

TEST(PixelTrace, AsJsonHasTheSameTree) {
  const PixelTrace trace = trace_of_a_ball();
  const nlohmann::json json = to_json(trace);
  ASSERT_EQ(json["samples"].size(), trace.samples.size());
  for (std::size_t i = 0; i < trace.samples.size(); ++i) {
    const RayRecord& ray = trace.samples[i].traced.ray;
    EXPECT_EQ(json["samples"][i]["ray"]["color"][0].get<double>(), ray.color.x);
    EXPECT_EQ(json["samples"][i]["ray"]["hit"]["leaf"], ray.hit->leaf);
    EXPECT_EQ(json["samples"][i]["ray"]["rays"].size(), ray.followed.size());
    EXPECT_EQ(json["samples"][i]["csg"]["leaves"].size(), trace.samples[i].story.leaves.size());
  }
}

TEST(PixelTrace, AsTextAndDrawingNamesWhatWasHit) {
  const PixelTrace trace = trace_of_a_ball();
  const std::string text = text_of(trace);
  for (const char* words : {"pixel 12,12 sample 3", "  ray 0, primary, from", "b<a>ll #0",
                            "ray 1, reflected, from", "ambient light 0", "in material: "})
    EXPECT_NE(text.find(words), std::string::npos) << words << text;
  const std::string svg = svg_of(trace);
  for (const char* words : {"<svg ", "b&lt;a>ll #0", "light 1", "camera", "</svg>"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace rayfarm
