// Recursive ray tracing of one sample. Source: T. Whitted, CACM 23(6), 1980.
//
// An observer (observer.h) is told of each ray as it is traced; who does not ask does not pay.
#pragma once
#include <functional>
#include <span>
#include <variant>

#include "common/math/number.h"
#include "common/render/camera_rays.h"
#include "common/render/hit.h"
#include "common/render/observer.h"
#include "common/render/sampler.h"
#include "common/render/settings.h"
#include "common/render/shade.h"

namespace rayfarm {

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
    return primary_radiance(observer, x, y);
  }

  /// The same, with another observer beside.
  template <class LightPoint, class Other>
  Vec3d radiance(double x, double y, LightPoint&& light_point, Other& other) {
    place_lights(light_point);
    Both<Observer, Other> both{observer, other};
    return primary_radiance(both, x, y);
  }

  std::optional<Hit> first_hit(double x, double y) { return nearest_hit(camera_.ray(x, y)); }

  const World::Parts& world() const { return world_; }

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

  template <class Watcher>
  Vec3d primary_radiance(Watcher& watcher, double x, double y) {
    watcher.begin(1.0);
    return radiance(watcher, camera_.ray(x, y), RayKind::primary, 0, 1.0);
  }

  template <class Watcher>
  Vec3d radiance(Watcher& watcher, const Ray& ray, RayKind kind, std::uint32_t depth, double importance) {
    if (++rays_since_question_ == rays_between_questions) {
      rays_since_question_ = 0;
      stopped_ = stopped_ || (stop && stop());
    }
    if (stopped_) return {};
    const std::optional<Hit> hit = nearest_hit(ray);
    watcher.traced(kind, ray, depth, importance, hit);
    const Vec3d color = hit ? radiance_at(watcher, *hit, -ray.direction, depth, importance) : background_;
    watcher.ended(color);
    return color;
  }

  template <class Watcher>
  Vec3d radiance_at(Watcher& watcher, const Hit& hit, const Vec3d& to_viewer, std::uint32_t depth,
                    double importance) {
    // Grazing, the rounded cosine can have the wrong sign; the side is known from the boundary.
    const double rounded = dot(hit.normal, to_viewer);
    const double cos_view = hit.entering ? greatest(rounded, smallest) : least(rounded, -smallest);
    Vec3d color = lights_.empty() ? hit.color : Vec3d{};
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      const Vec3d added = lights_[i].intensity * lit(watcher, hit, to_viewer, cos_view, lights_[i]);
      watcher.lit(i, lights_[i], added);
      color += added;
    }
    if (depth >= settings_.max_depth) {
      watcher.depth_reached();
      return color;
    }

    const Material& material = *hit.material;
    if (settings_.reflections) {
      const double weight = phong_weights(material, cos_view, hit.entering).specular;
      if (goes_on(importance * weight)) {
        watcher.begin(weight);
        const Ray ray = ray_from(hit, mirrored(to_viewer, hit.normal), hit.entering);
        color += radiance(watcher, ray, RayKind::reflected, depth + 1, importance * weight) * weight;
      } else {
        watcher.not_traced(RayKind::reflected, weight, NotTraced::importance);
      }
    }
    if (settings_.refractions) {
      const double weight = material.transmission;
      if (!goes_on(importance * weight)) {
        watcher.not_traced(RayKind::refracted, weight, NotTraced::importance);
      } else if (const std::optional<Vec3d> direction = refracted(to_viewer, hit.normal, material.index)) {
        watcher.begin(weight);
        const Ray ray = ray_from(hit, *direction, !hit.entering);
        color += radiance(watcher, ray, RayKind::refracted, depth + 1, importance * weight) * weight;
      } else {
        watcher.not_traced(RayKind::refracted, weight, NotTraced::total_reflection);
      }
    }
    return color;
  }

  /// A ray that adds nothing is not traced, whatever the limit says.
  bool goes_on(double importance) const { return importance > 0 && importance >= settings_.min_importance; }

  /// What a light sends to the viewer, as a factor of its intensity.
  template <class Watcher>
  Vec3d lit(Watcher& watcher, const Hit& hit, const Vec3d& to_viewer, double cos_view,
            const SampledLight& light) {
    if (light.is_ambient) return phong_ambient(*hit.material, hit.color, cos_view > 0);
    const Vec3d to_light = light.at - hit.point;
    if (!(dot(to_light, hit.normal) > 0)) return {};
    if (settings_.shadows) {
      const RayQuery query(ray_from(hit, to_light, true));
      const bool blocked = is_blocked(world_, query, workspace_);
      watcher.shadow_tested(query.ray, blocked);
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
