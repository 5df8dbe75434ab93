// Recursive ray tracing of one sample. Source: T. Whitted, CACM 23(6), 1980.
//
// An observer is told of each ray as it is traced; the default counts. A recorder of the ray tree is another
// one: the same code runs, and who did not ask for a record does not pay for it. Told is, for each ray:
//
//   begin(weight)                               what it shows counts so much in its parent's colour
//   traced(kind, ray, depth, importance, hit)   importance: the product of all weights up to here
//     per light: [shadow_tested(ray, blocked)]  at t = 1 of the ray is the light
//                lit(light, place, color)       color: what the light adds to the ray's
//     reflected, refracted:                     begin() to ended() of that ray, or
//                not_traced(kind, weight, why)
//     depth_reached()                           instead of these, when the rays may not go deeper
//   ended(color)
#pragma once
#include <functional>
#include <span>
#include <variant>

#include "common/math/number.h"
#include "common/render/camera_rays.h"
#include "common/render/counters.h"
#include "common/render/hit.h"
#include "common/render/sampler.h"
#include "common/render/settings.h"
#include "common/render/shade.h"

namespace rayfarm {

enum class RayKind : std::uint8_t { primary, reflected, refracted };

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
  void ended(const Vec3d& /*color*/) {}
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
};

/// Traces samples, one after another, in one thread.
template <class Observer>
class Tracer {
 public:
  Tracer(const World& world, const RenderSettings& settings, Observer observer = {})
      : observer(std::move(observer)),
        world_(world.parts()),
        settings_(settings),
        camera_(world.scene().camera, {settings.width, settings.height}),
        background_(vec(world.scene().background)) {}

  /// The light along the ray through film point (x, y). light_point(i) says where on light i, as u and v.
  template <class LightPoint>
  Vec3d radiance(double x, double y, LightPoint&& light_point) {
    place_lights(light_point);
    observer.begin(1.0);
    return radiance(camera_.ray(x, y), RayKind::primary, 0, 1.0);
  }

  std::optional<Hit> first_hit(double x, double y) { return nearest_hit(camera_.ray(x, y)); }

  Observer observer;

  /// Asked every few hundred rays, also in the middle of a sample: one sample may trace 2^depth of them. Once it
  /// has said true, all that is traced is black and of no use. Empty: never.
  std::function<bool()> stop;
  bool is_stopped() const { return stopped_; }

 private:
  static constexpr int rays_between_questions = 256;

  template <class LightPoint>
  void place_lights(LightPoint&& light_point) {
    lights_.clear();
    for (std::uint32_t i = 0; i < world_.scene.lights.size(); ++i) {
      const Light& light = world_.scene.lights[i];
      if (const auto* ambient = std::get_if<AmbientLight>(&light)) {
        lights_.push_back({true, {}, vec(ambient->intensity), nullptr});
      } else if (const auto* point = std::get_if<PointLight>(&light)) {
        lights_.push_back({false, vec(point->at), vec(point->intensity), nullptr});
      } else {
        const auto& r = std::get<RectangleLight>(light);
        const Sample2D s = light_point(i);
        lights_.push_back(
            {false, vec(r.at) + vec(r.width) * s.u + vec(r.height) * s.v, vec(r.intensity), &r});
      }
    }
  }

  std::optional<Hit> nearest_hit(const Ray& ray) {
    const RayQuery query(ray);
    const std::optional<Boundary> boundary = first_boundary(world_, query, workspace_);
    if (!boundary) return std::nullopt;
    return hit_at(world_, query, *boundary);
  }

  Vec3d radiance(const Ray& ray, RayKind kind, std::uint32_t depth, double importance) {
    if (++rays_since_question_ == rays_between_questions) {
      rays_since_question_ = 0;
      stopped_ = stopped_ || (stop && stop());
    }
    if (stopped_) return {};
    const std::optional<Hit> hit = nearest_hit(ray);
    observer.traced(kind, ray, depth, importance, hit);
    const Vec3d color = hit ? radiance_at(*hit, -ray.direction, depth, importance) : background_;
    observer.ended(color);
    return color;
  }

  Vec3d radiance_at(const Hit& hit, const Vec3d& to_viewer, std::uint32_t depth, double importance) {
    // Grazing, the rounded cosine can have the wrong sign; the side is known from the boundary.
    const double rounded = dot(hit.normal, to_viewer);
    const double cos_view = hit.entering ? greatest(rounded, smallest) : least(rounded, -smallest);
    Vec3d color = lights_.empty() ? hit.color : Vec3d{};
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      const Vec3d added = lights_[i].intensity * lit(hit, to_viewer, cos_view, lights_[i]);
      observer.lit(i, lights_[i], added);
      color += added;
    }
    if (depth >= settings_.max_depth) {
      observer.depth_reached();
      return color;
    }

    const Material& material = *hit.material;
    if (settings_.reflections) {
      const double weight = phong_weights(material, cos_view, hit.entering).specular;
      if (goes_on(importance * weight)) {
        observer.begin(weight);
        color += radiance(ray_from(hit, mirrored(to_viewer, hit.normal), hit.entering), RayKind::reflected,
                          depth + 1, importance * weight) *
                 weight;
      } else {
        observer.not_traced(RayKind::reflected, weight, NotTraced::importance);
      }
    }
    if (settings_.refractions) {
      const double weight = material.transmission;
      if (!goes_on(importance * weight)) {
        observer.not_traced(RayKind::refracted, weight, NotTraced::importance);
      } else if (const std::optional<Vec3d> direction = refracted(to_viewer, hit.normal, material.index)) {
        observer.begin(weight);
        color += radiance(ray_from(hit, *direction, !hit.entering), RayKind::refracted, depth + 1,
                          importance * weight) *
                 weight;
      } else {
        observer.not_traced(RayKind::refracted, weight, NotTraced::total_reflection);
      }
    }
    return color;
  }

  /// A ray that adds nothing is not traced, whatever the limit says.
  bool goes_on(double importance) const { return importance > 0 && importance >= settings_.min_importance; }

  /// What a light sends to the viewer, as a factor of its intensity.
  Vec3d lit(const Hit& hit, const Vec3d& to_viewer, double cos_view, const SampledLight& light) {
    if (light.is_ambient) return phong_ambient(*hit.material, hit.color, cos_view > 0);
    const Vec3d to_light = light.at - hit.point;
    if (!(dot(to_light, hit.normal) > 0)) return {};
    if (settings_.shadows) {
      const RayQuery query(ray_from(hit, to_light, true));
      const bool blocked = is_blocked(world_, query, workspace_);
      observer.shadow_tested(query.ray, blocked);
      if (blocked) return {};
    }
    const double distance = length(to_light);
    const Vec3d direct =
        phong(*hit.material, hit.color, hit.normal, to_viewer, cos_view, to_light * (1 / distance));
    if (!light.dimmed) return direct;
    const glm::dvec3& dim = light.dimmed->dim;
    return direct * (1 / (dim[0] + dim[1] * distance + dim[2] * distance * distance));
  }

  static constexpr double smallest = std::numeric_limits<double>::denorm_min();

  const World::Parts& world_;
  const RenderSettings& settings_;
  CameraRays camera_;
  Vec3d background_;
  std::vector<SampledLight> lights_;
  WorldWorkspace workspace_;
  int rays_since_question_ = 0;
  bool stopped_ = false;
};

}  // namespace rayfarm
