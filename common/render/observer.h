// Who watches the rays: told of each as it is traced, by the very code that renders. Told is, for each ray:
//
//   begin(weight)                               what it shows counts so much in its parent's colour
//   traced(kind, ray, depth, importance, hit)   importance: the product of all weights up to here
//     [lost()]                                  what it met contradicts the side to which it was sent
//     per light: [shadow_tested(ray, blocked)]  at t = 1 of the ray is the light
//                lit(light, place, color)       color: what the light adds to the ray's
//     reflected, refracted:                     begin() to ended() of that ray, or
//                not_traced(kind, weight, why)
//     depth_reached()                           instead of these, when the rays may not go deeper
//     [glowed(glow, color)]                     for each glow shell that the ray has passed: what it added
//   ended(color)
//
// or, where the camera has no ray for a sample, no_ray() alone.
#pragma once
#include <optional>

#include "common/render/counters.h"
#include "common/render/hit.h"

namespace rayfarm {

enum class RayKind : std::uint8_t { primary, reflected, refracted };

inline const char* name_of(RayKind kind) {
  constexpr const char* names[]{"primary", "reflected", "refracted"};
  return names[static_cast<int>(kind)];
}

enum class NotTraced : std::uint8_t { importance, total_reflection };

/// A light as one sample sees it: an area light has become a point of its own.
struct SampledLight {
  bool is_ambient = false;
  Vec3d at{}, intensity{};
  const RectangleLight* dimmed = nullptr;
};

/// An observer that heeds nothing, to derive those from that heed something.
struct IdleObserver {
  void begin(double /*weight*/) {}
  void traced(RayKind, const Ray&, std::uint32_t /*depth*/, double /*importance*/,
              const std::optional<Hit>&) {}
  void shadow_tested(const Ray&, bool /*blocked*/) {}
  void lit(std::size_t /*light*/, const SampledLight&, const Vec3d& /*color*/) {}
  void not_traced(RayKind, double /*weight*/, NotTraced) {}
  void depth_reached() {}
  void glowed(std::size_t /*glow*/, const Vec3d& /*color*/) {}
  void no_ray() {}
  void ended(const Vec3d& /*color*/) {}
  void lost() {}
};

struct CountingObserver : IdleObserver {
  RayCounters counters;

  void traced(RayKind kind, const Ray&, std::uint32_t, double, const std::optional<Hit>& hit) {
    switch (kind) {
      case RayKind::primary:
        ++counters.primary, counters.primary_hits += hit.has_value();
        return;
      case RayKind::reflected:
        ++counters.reflected, counters.secondary_hits += hit.has_value();
        return;
      case RayKind::refracted:
        ++counters.refracted, counters.secondary_hits += hit.has_value();
        return;
    }
  }
  void shadow_tested(const Ray&, bool) { ++counters.shadow; }
  void lost() { ++counters.lost; }
};

/// Two observers at once.
template <class First, class Second>
struct Both {
  First& first;
  Second& second;

  void begin(double weight) { first.begin(weight), second.begin(weight); }
  void traced(RayKind kind, const Ray& ray, std::uint32_t depth, double importance,
              const std::optional<Hit>& hit) {
    first.traced(kind, ray, depth, importance, hit), second.traced(kind, ray, depth, importance, hit);
  }
  void shadow_tested(const Ray& ray, bool blocked) {
    first.shadow_tested(ray, blocked), second.shadow_tested(ray, blocked);
  }
  void lit(std::size_t light, const SampledLight& sampled, const Vec3d& color) {
    first.lit(light, sampled, color), second.lit(light, sampled, color);
  }
  void not_traced(RayKind kind, double weight, NotTraced why) {
    first.not_traced(kind, weight, why), second.not_traced(kind, weight, why);
  }
  void lost() { first.lost(), second.lost(); }
  void depth_reached() { first.depth_reached(), second.depth_reached(); }
  void glowed(std::size_t glow, const Vec3d& color) { first.glowed(glow, color), second.glowed(glow, color); }
  void no_ray() { first.no_ray(), second.no_ray(); }
  void ended(const Vec3d& color) { first.ended(color), second.ended(color); }
};

}  // namespace rayfarm
