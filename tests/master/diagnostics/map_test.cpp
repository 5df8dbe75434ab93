#include "master/diagnostics/map_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "common/render/pixel.h"
#include "master/diagnostics/statistics.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

const MapKind *depth = map_named("depth"), *normal = map_named("normal"),
              *normal_camera = map_named("normal-camera"), *primary_rays = map_named("primary-rays"),
              *all_rays = map_named("all-rays"), *samples = map_named("samples"), *cost = map_named("cost");
const auto never = [] { return false; };
const auto unheard = [](std::uint32_t, std::uint32_t) {};

RenderSettings small_settings(std::uint32_t spp = 16) {
  RenderSettings s;
  s.width = 70, s.height = 66, s.spp = spp;
  return s;
}

Map map_by(const Scene& scene, const MapRequest& request, const RenderSettings& s = small_settings()) {
  return *map_of(World(scene), s, request, 2, never, unheard);
}

/// Five balls of radius 1 far before a plane; the picture's edges are those of the balls. Camera at the origin.
constexpr double plane_distance = 100;
Scene balls_before_a_plane() {
  Scene scene;
  scene.nodes = {{Operation{CsgOp::unite, 6}, {}, {}, {}, {}, {}}};
  for (int i = 0; i < 5; ++i)
    scene.nodes.push_back(
        {Sphere{}, Affine{glm::dmat3(1.0), {2.3 * (i - 2), 0.7 * (i % 2), 10}}, {}, {}, {}, {}});
  const Affine facing{glm::dmat3({1, 0, 0}, {0, -1, 0}, {0, 0, -1}), {0, 0, plane_distance}};
  scene.nodes.push_back({Plane{}, facing, {}, {}, {}, {}});
  scene.camera = PerspectiveCamera{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 60};
  return scene;
}

bool is_depth_of_a_surface(double depth) {
  return (depth > 8.5 && depth < 12) || depth > plane_distance - 1e-3;
}

TEST(Map, NoReductionButTheMeanShowsADepthOfNoSurface) {
  int mixed = 0;
  for (const Reduction reduction :
       {Reduction::majority, Reduction::closest, Reduction::median, Reduction::mean})
    for (const float value : map_by(balls_before_a_plane(), {depth, reduction}).values) {
      const bool right = is_depth_of_a_surface(value);
      if (reduction == Reduction::mean)
        mixed += !right;
      else
        EXPECT_TRUE(right) << value;
    }
  EXPECT_GT(mixed, 30);  // why the others are there
}

TEST(Map, CoveragesOfTheRankedSurfacesAddUpToTheSamplesThatHit) {
  const Scene scene = balls_before_a_plane();  // no pixel shows more than four surfaces
  std::vector<float> sum;
  for (const Reduction rank : {Reduction::majority, Reduction::second, Reduction::third, Reduction::fourth}) {
    const Map coverage = map_by(scene, {map_named("coverage"), rank}),
              distance = map_by(scene, {depth, rank});
    sum.resize(coverage.values.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += coverage.values[i];
      const bool is_shown = coverage.values[i] > 0;
      EXPECT_EQ(is_shown, std::isfinite(distance.values[i]));
      EXPECT_TRUE(!is_shown || is_depth_of_a_surface(distance.values[i]));
      EXPECT_LE(coverage.values[i], rank == Reduction::majority ? 1 : 0.5);
    }
  }
  for (const float all : sum) EXPECT_EQ(all, 1);  // the plane is everywhere
}

TEST(Map, WherePixelsShowNothingTheDepthIsInfinite) {
  Scene scene = balls_before_a_plane();
  scene.nodes.pop_back();
  std::get<Operation>(scene.nodes[0].content).children = 5;
  int infinite = 0;
  for (const float value : map_by(scene, {depth}).values) {
    EXPECT_TRUE(value < 12 || std::isinf(value)) << value;
    infinite += std::isinf(value);
  }
  EXPECT_GT(infinite, 70 * 66 / 2);
}

TEST(Map, ANormalAtAnEdgeIsThatOfTheSurfaceThatMostSamplesShow) {
  // The truth: the mean normal of what 64 times as many samples show of the same surface.
  const Scene scene = balls_before_a_plane();
  const World world(scene);
  RenderSettings few = small_settings(64), many = small_settings(4096);
  double error_sum = 0;
  int edges = 0;
  for (std::uint32_t y = 26; y < 38; ++y)
    for (std::uint32_t x = 0; x < 70; ++x) {
      const auto surfaces = [&](const RenderSettings& s) {
        Tracer<CountingObserver> tracer(world, s);
        const PixelSampler sampler(s, {x, y});
        PixelSurfaces found(world, Reduction::majority);
        for (std::uint32_t i = 0; i < s.spp; ++i) {
          const Sample2D place = sampler.sample(i, 0);
          if (const auto hit = tracer.first_hit(x + place.u, y + place.v)) found.add(*hit, 1);
        }
        return found.ranked();
      };
      const std::vector<Surface> seen = surfaces(few);
      if (seen.size() < 2) continue;
      for (const Surface& truth : surfaces(many)) {
        if (truth.leaf() != seen[0].leaf()) continue;
        const double cosine = std::min(1.0, dot(truth.normal(), seen[0].normal()));
        error_sum += std::acos(cosine) * 180 / 3.14159265358979;
        ++edges;
        break;
      }
    }
  EXPECT_GT(edges, 20);
  EXPECT_LE(error_sum / edges, 1.0);  // degrees
}

TEST(Map, CountsAddUpToTheStatistics) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Scene scene = random_scene(seed);
    const RenderSettings s = small_settings(4);
    const RayCounters c = statistics_of(World(scene), s, 2, never, unheard)->rays;
    const auto sum = [&](const MapRequest& request) {
      const Map map = map_by(scene, request, s);
      return std::accumulate(map.values.begin(), map.values.end(), 0.0);
    };
    EXPECT_EQ(sum({samples}), c.primary);
    EXPECT_EQ(sum({primary_rays}), c.primary_hits);
    EXPECT_EQ(sum({all_rays}), c.primary_hits + c.secondary_hits + c.shadow);
    EXPECT_EQ(sum({all_rays, {}, true}), c.primary_hits + c.secondary_hits);
    EXPECT_GT(sum({cost}), 0);
  }
}

TEST(Map, ANormalRelativeToTheCameraIsTheSameNormalInItsAxes) {
  const Scene scene = random_scene(2);
  const Map world = map_by(scene, {normal}), camera = map_by(scene, {normal_camera});
  const CameraAxes axes = CameraRays(scene.camera, {70, 66}).axes();
  for (std::size_t i = 0; i < world.values.size(); i += 3) {
    const Vec3d n{camera.values[i], camera.values[i + 1], camera.values[i + 2]};
    ASSERT_EQ(std::isinf(n.x), std::isinf(world.values[i]));
    if (std::isinf(n.x)) continue;
    const Vec3d back = axes.right * n.x + axes.up * n.y + axes.forward * n.z;
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(back[c], world.values[i + static_cast<std::size_t>(c)], 1e-6);
  }
}

TEST(Map, IsTheSameForAnyNumberOfThreads) {
  const World world(random_scene(5));
  for (const MapKind* kind : {depth, normal, all_rays}) {
    const Map one = *map_of(world, small_settings(4), {kind}, 1, never, unheard);
    EXPECT_EQ(one.values, map_of(world, small_settings(4), {kind}, 5, never, unheard)->values);
  }
  EXPECT_FALSE(map_of(
      world, small_settings(), {}, 2, [] { return true; }, unheard));
}

/// What the PNG will hold: 0..255.
std::vector<int> bytes_of(const Picture& picture) {
  std::vector<int> bytes;
  for (const float value : picture.rgb)
    bytes.push_back(static_cast<int>(std::lround(255 * std::pow(value, 1 / 2.2))));
  return bytes;
}

TEST(MapColors, AreTheOriginals) {
  const float inf = std::numeric_limits<float>::infinity();
  const Size row{3, 1};
  EXPECT_EQ(bytes_of(colored({row, 1, {2, 6, 10}}, *all_rays)),
            (std::vector<int>{0, 0, 255, 0, 255, 0, 255, 0, 0}));
  EXPECT_EQ(bytes_of(colored({row, 1, {7, 7, 7}}, *samples)),
            (std::vector<int>{255, 0, 0, 255, 0, 0, 255, 0, 0}));
  EXPECT_EQ(bytes_of(colored({row, 1, {1, 10, inf}}, *depth)),
            (std::vector<int>{255, 255, 255, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(bytes_of(colored({row, 3, {0, 0, -1, 1, 0, 0, inf, inf, inf}}, *normal)),
            (std::vector<int>{127, 127, 255, 254, 127, 128, 0, 0, 0}));
}

TEST(MapColors, OfAFixedRangeAreTheSameInEveryPicture) {
  const MapColors fixed{MapPalette::original, MapRange{0, 100}};
  const std::vector<int> few = bytes_of(colored({{2, 1}, 1, {0, 50}}, *all_rays, fixed));
  const std::vector<int> more = bytes_of(colored({{2, 1}, 1, {50, 1000}}, *all_rays, fixed));
  EXPECT_EQ(few, (std::vector<int>{0, 0, 255, 0, 255, 0}));
  EXPECT_EQ(more, (std::vector<int>{0, 255, 0, 255, 0, 0}));  // 1000 as 100
}

TEST(MapColors, OfThePerceptualPaletteGrowLighterEvenly) {
  const auto lightness = [](const MapColor& c) {  // CIE 15, of sRGB primaries at gamma 2.2
    const auto linear = [](std::uint8_t byte) { return std::pow(byte / 255.0, 2.2); };
    const double y = 0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]);
    return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
  };
  const auto at = [&](MapScale scale, double value) {
    const auto number = static_cast<float>(value);
    return lightness(color_of(&number, scale, MapPalette::perceptual, {1, 17}));
  };
  const double count_step = (at(MapScale::count, 17) - at(MapScale::count, 1)) / 16;
  const double depth_step = (at(MapScale::depth, 1) - at(MapScale::depth, 17)) / 16;
  EXPECT_GT(count_step, 4);
  EXPECT_GT(depth_step, 4);
  for (int i = 0; i < 16; ++i) {
    EXPECT_NEAR(at(MapScale::count, i + 2) - at(MapScale::count, i + 1), count_step,
                0.4 * count_step);  // viridis is even in another model of lightness, CAM02-UCS
    const double near = std::pow(17, i / 16.0), far = std::pow(17, (i + 1) / 16.0);
    EXPECT_NEAR(at(MapScale::depth, near) - at(MapScale::depth, far), depth_step, 0.3 * depth_step);
  }
}

TEST(MapColors, OfALegendAreThoseOfThePicture) {
  for (const MapKind& kind : all_maps()) {
    Map map{{20, 50}, kind.channels.size(), {}};
    for (std::size_t i = 0; i < 1000 * map.channels; ++i)
      map.values.push_back(kind.scale == MapScale::normal ? 0.6f : static_cast<float>(i / 10));
    const Picture plain = colored(map, kind), with = colored_with_legend(map, kind);
    ASSERT_GT(with.size.width, 20u);
    for (std::size_t y = 0; y < 50; ++y)
      for (std::size_t i = 0; i < 60; ++i)
        ASSERT_EQ(with.rgb[3 * y * with.size.width + i], plain.rgb[60 * y + i]) << kind.name;
    if (kind.scale != MapScale::count && kind.scale != MapScale::depth) continue;
    const std::size_t bar = 3 * (20 + 6), top = bar, bottom = bar + 49 * 3 * with.size.width;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(with.rgb[top + c], plain.rgb[3 * 999 + c]) << kind.name;
      EXPECT_EQ(with.rgb[bottom + c], plain.rgb[c]) << kind.name;
    }
  }
}

TEST(MapKinds, HaveNamesOfTheirOwnAndWordsForPeople) {
  std::set<std::string_view> names, channels;
  std::size_t channel_count = 0;
  for (const MapKind& kind : all_maps()) {
    names.insert(kind.name);
    channels.insert(kind.channels.begin(), kind.channels.end());
    channel_count += kind.channels.size();
    EXPECT_EQ(map_named(kind.name), &kind);
    EXPECT_FALSE(kind.title.empty() || kind.unit.empty() || kind.help.empty()) << kind.name;
    EXPECT_EQ(kind.put == nullptr, kind.source == MapSource::farm) << kind.name;
    EXPECT_EQ(kind.channels.size(), kind.scale == MapScale::normal ? 3u : 1u) << kind.name;
  }
  EXPECT_EQ(names.size(), all_maps().size());
  EXPECT_EQ(channels.size(), channel_count);  // of one EXR
  EXPECT_EQ(map_named("no such map"), nullptr);
}

TEST(MapCsv, HasALineForEachRow) {
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(csv({{2, 2}, 1, {1, 2.5, inf, 0.1f}}, "depth"), "# depth\n1;2.5\ninf;0.1\n");
  EXPECT_EQ(csv({{2, 1}, 3, {1, 2, 3, inf, inf, inf}}, "normal"), "# normal\n1;2;3;inf;inf;inf\n");
}

}  // namespace
}  // namespace rayfarm
