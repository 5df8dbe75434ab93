// The rays behind one sample of a pixel, as a tree, recorded by the code that renders.
#pragma once
#include <optional>
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
  Vec3d origin{}, direction{};
  Vec3d color{};  // the light along it: the background's if it hit nothing
  std::optional<RayHit> hit;
  std::vector<LightAtHit> lights;
  std::vector<RayRecord> followed;  // reflected, then refracted
  std::vector<Untraced> untraced;
  bool depth_reached = false;  // so nothing was followed
};

struct TracedSample {
  std::optional<std::uint32_t> number;  // none: the pixel's centre, which the picture did not use
  double x = 0, y = 0;                  // on the film, in pixels
  RayRecord ray;
};

/// Sample `number` of the pixel as the render traced it: the same rays and bits. The pixel lies in the picture,
/// the number is less than settings.spp.
TracedSample traced_sample(const World& world, const RenderSettings& settings, Pixel pixel,
                           std::uint32_t number);
/// Through the pixel's centre and to the lights' middles.
TracedSample traced_centre(const World& world, const RenderSettings& settings, Pixel pixel);

}  // namespace rayfarm
