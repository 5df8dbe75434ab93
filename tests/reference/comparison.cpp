#include "tests/reference/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/render/probe.h"

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

// The most that the reference changes when its ray is moved a little, to any side.
Apart sensitivity(const ReferenceTracer& tracer, const ReferenceSettings& film, const ReferenceSample& here,
                  double x, double y) {
  Apart most;
  const double step = nudge * film.width;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const ReferenceSample there = tracer.sample(film, x + dx * step, y + dy * step);
      const Apart a = apart(here.first_hit, here.color, there.first_hit, there.color);
      most = {std::max(most.distance, a.distance), std::max(most.normal, a.normal),
              std::max(most.color, a.color)};
    }
  return {most.distance + rounding.distance, most.normal + rounding.normal, most.color + rounding.color};
}

template <class Hit>
std::string text(const std::optional<Hit>& hit) {
  return hit ? "leaf " + std::to_string(hit->leaf) + " at " + std::to_string(hit->distance) : "no hit";
}

ReferenceSettings reference_settings(const RenderSettings& settings) {
  return {.width = double(settings.width),
          .height = double(settings.height),
          .max_depth = static_cast<int>(settings.max_depth),
          .min_importance = settings.min_importance,
          .shadows = settings.shadows,
          .reflections = settings.reflections,
          .refractions = settings.refractions};
}

}  // namespace

Comparison::Comparison(std::string name, const Scene& scene, const RenderSettings& settings)
    : name_(std::move(name)),
      scene_(scene),
      settings_(settings),
      reference_(reference_settings(settings)),
      tracer_(scene_),
      world_(scene) {}

void Comparison::compare_at(double x, double y) {
  ++rays_;
  const ReferenceSample expected = tracer_.sample(reference_, x, y);
  const Probe got = probe(world_, settings_, x, y, {reference_.light_uv.x, reference_.light_uv.y});
  const Apart found = apart(expected.first_hit, expected.color, got.first_hit, got.color);
  if (within(found, rounding)) return;
  if (!within(found, {1e-3, 1e-3, 1e-3})) ++at_edges_;
  const Apart allowed = sensitivity(tracer_, reference_, expected, x, y);
  if (within(found, allowed)) return;
  ++wrong_;
  ADD_FAILURE() << name_ << " at (" << x << ", " << y << "): apart by " << found.distance << " in distance, "
                << found.normal << " in normal, " << found.color << " in colour; allowed " << allowed.distance
                << ", " << allowed.normal << ", " << allowed.color << "; reference "
                << text(expected.first_hit) << ", core " << text(got.first_hit);
}

void Comparison::compare_rows(std::uint32_t y0, std::uint32_t y1, double place) {
  for (std::uint32_t y = y0; y < y1; ++y)
    for (std::uint32_t x = 0; x < settings_.width && wrong_ < 10; ++x) compare_at(x + place, y + place);
}

void Comparison::expect_few_at_edges() const {
  EXPECT_LE(at_edges_, 2 + rays_ / 2000) << name_ << ", of " << rays_ << " rays";
}

}  // namespace rayfarm
