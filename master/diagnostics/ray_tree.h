// The rays behind one sample of a pixel, as a tree, recorded by the code that renders.
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/render/pixel.h"

namespace rayfarm {

struct RayHit {
  double distance = 0;      // from the ray's origin
  Vec3d point{}, normal{};  // the normal is unit and points out of the material
  Vec3d surface_color{};
  std::uint32_t leaf = 0;
  bool entering = false;  // the ray goes into the material
};

enum class LightFate : std::uint8_t { ambient, reached, blocked, behind };  // behind: the surface faces away

/// What first stands between a surface and a light.
struct Blocker {
  std::uint32_t leaf = 0;
  Vec3d point{};
};

/// A light as a hit sees it.
struct LightAtHit {
  std::size_t light = 0;  // number in the scene
  LightFate fate = LightFate::ambient;
  Vec3d at{};                      // where this sample aims at; not for ambient light
  Vec3d color{};                   // added to the ray's colour
  std::optional<Blocker> blocker;  // none for a surface that lies within another solid, up to rounding
};

/// What a glow shell that the ray passed added to its colour.
struct GlowOnRay {
  std::size_t glow = 0;  // number among the scene's
  Vec3d color{};
};

/// A reflected or refracted ray that the material asks for and that was not traced.
struct Untraced {
  RayKind kind = RayKind::reflected;
  double weight = 0;
  NotTraced why = NotTraced::importance;
};

struct RayRecord {
  RayKind kind = RayKind::primary;
  std::uint32_t depth = 0;
  double weight = 1;      // of its colour in its parent's
  double importance = 1;  // of its colour in the sample's: the product of all weights
  Ray path{};             // where it ran
  Vec3d color{};          // the light along it: the background's if it hit nothing
  std::optional<RayHit> hit;
  std::vector<LightAtHit> lights;
  std::vector<GlowOnRay> glows;
  std::vector<RayRecord> followed;  // reflected, then refracted
  std::vector<Untraced> untraced;
  bool depth_reached = false;  // so nothing was followed
};

struct TracedSample {
  std::optional<std::uint32_t> number;  // none: the pixel's centre, which the picture did not use
  double x = 0, y = 0;                  // on the film, in pixels
  std::uint32_t weight = 1;             // in the pixel's mean
  RayRecord ray;
};

/// Which samples of a pixel: one by its number, all, or a ray through its centre and to the lights' middles.
struct EverySample {};
struct PixelCentre {};
using SampleChoice = std::variant<std::uint32_t, EverySample, PixelCentre>;
/// "3", "all" or "centre". Throws SettingsError.
SampleChoice sample_choice(const std::string& text, const RenderSettings& settings);

/// A sample may trace 2^depth rays.
struct RecordLimits {
  std::size_t rays = std::numeric_limits<std::size_t>::max();  // those to the lights, too
  std::function<bool()> stop{};                                // asked every few hundred rays; empty: never
};

struct TracedSamples {
  std::vector<TracedSample> samples;
  bool truncated = false;  // rays are missing from here on; those on the way to them have no colour
};

/// Samples of the pixel as the render traced them: the same rays and bits; without those for which the camera has no
/// ray. Throws SettingsError for what the picture has not got.
TracedSamples traced_samples(const World& world, const RenderSettings& settings, Pixel pixel,
                             const SampleChoice& choice, const RecordLimits& limits = {});

}  // namespace rayfarm
