// The core against the reference tracer: first hit and colour, pixel centre by pixel centre.
//
// The two may differ by what the reference itself changes when its ray is moved by 1e-9 of the picture's
// width. So a smooth place must agree to many digits, a pixel may differ only where the ray grazes an edge
// within rounding, and these are counted: a missing surface or a speckle fails.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "common/render/probe.h"
#include "common/render/world.h"
#include "master/script/script.h"
#include "tests/reference/reference_tracer.h"
#include "tests/support/random_scene.h"

namespace rayfarm {
namespace {

/// How far two answers for one ray lie apart: relative in distance, absolute in normal and colour; infinite
/// when they are not about the same surface.
struct Apart {
  double distance = 0, normal = 0, color = 0;
};

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Apart rounding{1e-12, 1e-10, 1e-9};  // what well-placed rays agree to
constexpr double nudge = 1e-9;                 // of the picture's width

// Hit: ReferenceHit or ProbeHit.
template <class Hit>
Apart apart(const std::optional<ReferenceHit>& a, const glm::dvec3& a_color, const std::optional<Hit>& b,
            const glm::dvec3& b_color) {
  const glm::dvec3 d = glm::abs(a_color - b_color);
  Apart result{0, 0, std::max({d.x, d.y, d.z})};
  if (!std::isfinite(d.x + d.y + d.z)) result.color = infinity;
  if (!a && !b) return result;
  if (!a || !b || a->leaf != static_cast<int>(b->leaf)) return {infinity, infinity, result.color};
  result.distance = std::abs(a->distance - b->distance) / a->distance;
  result.normal = glm::length(a->normal - b->normal);
  return result;
}

bool within(const Apart& a, const Apart& limit) {
  return a.distance <= limit.distance && a.normal <= limit.normal && a.color <= limit.color;
}

class Comparison {
 public:
  Comparison(std::string name, const Scene& scene, const RenderSettings& settings)
      : name_(std::move(name)), scene_(scene), settings_(settings), tracer_(scene_), world_(scene) {
    reference_.width = settings.width, reference_.height = settings.height;
    reference_.max_depth = static_cast<int>(settings.max_depth);
    reference_.min_importance = settings.min_importance;
  }

  void compare_at(double x, double y) {
    ++rays_;
    const ReferenceSample expected = tracer_.sample(reference_, x, y);
    const Probe got = probe(world_, settings_, x, y, {reference_.light_uv.x, reference_.light_uv.y});
    const Apart found = apart(expected.first_hit, expected.color, got.first_hit, got.color);
    if (within(found, rounding)) return;
    const Apart allowed = sensitivity(expected, x, y);
    if (!within(found, allowed)) {
      ADD_FAILURE() << name_ << " at (" << x << ", " << y << "): apart by " << found.distance
                    << " in distance, " << found.normal << " in normal, " << found.color
                    << " in colour; allowed " << allowed.distance << ", " << allowed.normal << ", "
                    << allowed.color << "; reference " << text(expected.first_hit) << ", core "
                    << text(got.first_hit);
      ++wrong_;
    }
    if (!within(found, {1e-3, 1e-3, 1e-3})) ++at_edges_;
  }

  void compare_pixel_centres(std::uint32_t stride) {
    for (std::uint32_t y = stride / 2; y < settings_.height; y += stride)
      for (std::uint32_t x = stride / 2; x < settings_.width && wrong_ < 10; x += stride)
        compare_at(x + 0.5, y + 0.5);
  }

  /// Few rays pass so near an edge that rounding decides.
  void expect_few_at_edges() const {
    EXPECT_LE(at_edges_, 2 + rays_ / 2000) << name_ << ", of " << rays_ << " rays";
  }

 private:
  // The most that the reference changes when its ray is moved a little, to any side.
  Apart sensitivity(const ReferenceSample& here, double x, double y) const {
    Apart most = rounding;
    const double step = nudge * settings_.width;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const ReferenceSample there = tracer_.sample(reference_, x + dx * step, y + dy * step);
        const Apart a = apart(here.first_hit, here.color, there.first_hit, there.color);
        most = {std::max(most.distance, a.distance), std::max(most.normal, a.normal),
                std::max(most.color, a.color)};
      }
    return most;
  }

  template <class Hit>
  static std::string text(const std::optional<Hit>& hit) {
    return hit ? "leaf " + std::to_string(hit->leaf) + " at " + std::to_string(hit->distance) : "no hit";
  }

  std::string name_;
  Scene scene_;
  RenderSettings settings_;
  ReferenceSettings reference_;
  ReferenceTracer tracer_;
  World world_;
  int rays_ = 0, wrong_ = 0, at_edges_ = 0;
};

void expect_agreement(const std::string& scene, const std::map<std::string, std::string>& params = {},
                      std::uint32_t stride = 1) {
  const std::string file = std::string(RAYFARM_SOURCE_DIR) + "/scenes/" + scene + ".lua";
  RenderSettings settings;
  settings.width = 320, settings.height = 240;
  Comparison comparison(scene, evaluate_file(file, params, 0).scene, settings);
  comparison.compare_pixel_centres(stride);
  comparison.expect_few_at_edges();
}

TEST(Agreement, SpherePlane) { expect_agreement("sphere_plane"); }
TEST(Agreement, HedgehogInTheCage) { expect_agreement("hedgehog_in_the_cage"); }
TEST(Agreement, Circus) { expect_agreement("circus"); }
TEST(Agreement, TestSceneWithAPointLight) { expect_agreement("test_scene", {{"light", "point"}}); }
TEST(Agreement, TestSceneWithARectangleLight) { expect_agreement("test_scene", {{"light", "rectangle"}}); }
TEST(Agreement, SphereFlakeOfDepthThree) { expect_agreement("sphere_flake", {{"depth", "3"}}); }
TEST(Agreement, SphereFlakeOfDepthFive) { expect_agreement("sphere_flake", {}, 8); }
TEST(Agreement, SphereFlakeOfMirrors) {
  expect_agreement("sphere_flake", {{"depth", "3"}, {"mat", "mirror"}});
}
TEST(Agreement, SphereFlakeOfGlass) { expect_agreement("sphere_flake", {{"depth", "3"}, {"mat", "glass"}}); }

// Random scenes, sampled on a grid that no symmetry of the scene shares.
void expect_agreement_on_random_scenes(const std::string& family, Scene (*make)(std::uint64_t),
                                       std::uint64_t first, std::uint64_t last) {
  RenderSettings settings;
  settings.width = 320, settings.height = 240;
  settings.max_depth = 4;
  for (std::uint64_t seed = first; seed < last && !testing::Test::HasFailure(); ++seed) {
    Comparison comparison(family + " " + std::to_string(seed), make(seed), settings);
    for (double y = 3.137; y < settings.height; y += 17.31)
      for (double x = 5.713; x < settings.width; x += 15.77) comparison.compare_at(x, y);
    comparison.expect_few_at_edges();
  }
}

TEST(Agreement, RandomScenesOfAnyTransforms) {
  expect_agreement_on_random_scenes("random", random_scene, 0, 150);
}
TEST(Agreement, RandomScenesOfCoincidentFaces) {
  expect_agreement_on_random_scenes("snapped", random_snapped_scene, 0, 150);
}

}  // namespace
}  // namespace rayfarm
