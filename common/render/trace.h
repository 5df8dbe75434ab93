// Recursive ray tracing of one sample. Source: T. Whitted, CACM 23(6), 1980.
//
// An observer (observer.h) is told of each ray as it is traced; who does not ask does not pay.
#pragma once
#include <functional>
#include <span>
#include <variant>

#include "common/math/number.h"
#include "common/render/camera_rays.h"
#include "common/render/glow.h"
#include "common/render/hit.h"
#include "common/render/observer.h"
#include "common/render/sampler.h"
#include "common/render/settings.h"
#include "common/render/shade.h"

namespace rayfarm {

/// Who heeds pixels and their primary rays alone watches them, beside the observer. Pictures are rendered by the
/// same code with and without one: it is asked for once a pixel and once a primary ray.
class PixelWatch {
 public:
  explicit PixelWatch(bool hears_misses) : hears_misses(hears_misses) {}
  /// The pixel's samples come next, or have been traced, those of a pass in order; one that is given up never ends.
  /// Of its pass, so much is counted.
  virtual void pixel_begins(const RayCounters& counters) = 0;
  virtual void pixel_ended(Pixel pixel, const RayCounters& counters) = 0;
  /// A primary ray has ended there. If misses are heard: nowhere when it hits nothing or the camera has none.
  virtual void ray_ended(const std::optional<Hit>& hit) = 0;
  /// The weight of a pixel's sample, by number, that an adaptive sampler has given it when all are traced.
  virtual void sample_weighed(std::uint32_t number, std::uint32_t weight) = 0;

  const bool hears_misses;

 protected:
  ~PixelWatch() = default;
};

/// What tracing needs, whoever watches.
struct TracerState {
  const World::Parts& world;
  const RenderSettings& settings;
  CameraRays camera;
  Vec3d background;
  PixelWatch* watch = nullptr;
  std::vector<SampledLight> lights{};  // of the sample
  WorldWorkspace workspace{};
  std::function<bool()> stop{};
  int rays_since_question = 0;
  bool stopped = false;
};

/// Traces samples, one after another, in one thread.
template <class Observer, class State = TracerState>  // TracerState&: another tracer's
class Tracer {
 public:
  Tracer(const World& world, const RenderSettings& settings, Observer observer = {})
      : observer(std::move(observer)),
        state_{world.parts(),
               settings,
               {world.scene().camera, {settings.width, settings.height}},
               vec(world.scene().background)} {}
  Tracer(Observer observer, State state) : observer(std::move(observer)), state_(state) {}

  /// The light along the ray through film point (x, y), none where the camera has no ray. light_point(i) says where
  /// on light i, as u and v.
  template <class LightPoint>
  Vec3d radiance(double x, double y, LightPoint&& light_point) {
    const std::optional<Ray> ray = state_.camera.ray(x, y);
    if (!ray) {
      observer.no_ray();
      if (state_.watch && state_.watch->hears_misses) state_.watch->ray_ended(std::nullopt);
      return {};
    }
    place_lights(light_point);
    observer.begin(1.0);
    return radiance<RayKind::primary>(*ray, 0, 1.0);
  }

  /// The same, while another observer is told, too.
  template <class LightPoint, class Other>
  Vec3d radiance(double x, double y, LightPoint&& light_point, Other& other) {
    return Tracer<Both<Observer, Other>, TracerState&>({observer, other}, state_).radiance(x, y, light_point);
  }

  std::optional<Hit> first_hit(double x, double y) {
    const std::optional<Ray> ray = state_.camera.ray(x, y);
    return ray ? nearest_hit(RayQuery(*ray)) : std::nullopt;
  }

  const World::Parts& world() const { return state_.world; }

  Observer observer;

  /// stop() is asked every few hundred rays, also in the middle of a sample: one sample may trace 2^depth of them.
  /// Once it has said true, all that is traced is black and of no use. Empty: never.
  template <class Stop>
  void stop_when(Stop&& stop) {
    state_.stop = std::forward<Stop>(stop);
  }
  bool is_stopped() const { return state_.stopped; }

  /// Null: nobody. It must outlive the tracer.
  void set_watch(PixelWatch* watch) { state_.watch = watch; }
  PixelWatch* watch() const { return state_.watch; }

 private:
  static constexpr int rays_between_questions = 256;

  template <class LightPoint>
  void place_lights(LightPoint&& light_point) {
    state_.lights.clear();
    for (std::uint32_t i = 0; i < state_.world.scene.lights.size(); ++i) {
      const Light& light = state_.world.scene.lights[i];
      if (const auto* ambient = std::get_if<AmbientLight>(&light)) {
        state_.lights.push_back({true, {}, vec(ambient->intensity), nullptr});
      } else if (const auto* point = std::get_if<PointLight>(&light)) {
        state_.lights.push_back({false, vec(point->at), vec(point->intensity), nullptr});
      } else {
        const auto& r = std::get<RectangleLight>(light);
        const Sample2D s = light_point(i);
        state_.lights.push_back(
            {false, vec(r.at) + vec(r.width) * s.u + vec(r.height) * s.v, vec(r.intensity), &r});
      }
    }
  }

  std::optional<Hit> nearest_hit(const RayQuery& query) {
    const std::optional<Boundary> boundary = first_boundary(state_.world, query, state_.workspace);
    if (!boundary) return std::nullopt;
    return hit_at(state_.world, query, *boundary);
  }

  template <RayKind kind>
  Vec3d radiance(const Ray& ray, std::uint32_t depth, double importance) {
    if (++state_.rays_since_question == rays_between_questions) {
      state_.rays_since_question = 0;
      state_.stopped = state_.stopped || (state_.stop && state_.stop());
    }
    if (state_.stopped) return {};
    const RayQuery query(ray);
    const std::optional<Hit> hit = nearest_hit(query);
    observer.traced(kind, ray, depth, importance, hit);
    if (kind == RayKind::primary && state_.watch && (hit || state_.watch->hears_misses))
      state_.watch->ray_ended(hit);
    Vec3d color = hit ? radiance_at(*hit, ray, depth, importance) : radiance_of_nothing(ray);
    for (std::uint32_t i = 0; i < state_.world.glows.size(); ++i)
      if (const std::optional<Vec3d> glow = glow_along(state_.world.glows[i], query, hit)) {
        observer.glowed(i, *glow);
        color += *glow;
      }
    observer.ended(color);
    return color;
  }

  Vec3d radiance_of_nothing(const Ray& ray) {
    if (is_sent_inside(ray) && !ends_inside(state_.world, RayQuery(ray), state_.workspace)) observer.lost();
    return state_.background;
  }

  Vec3d radiance_at(const Hit& hit, const Ray& ray, std::uint32_t depth, double importance) {
    if (contradicts(ray, hit) && !hit.is_sheet) observer.lost();
    const Vec3d to_viewer = -ray.direction;
    // Grazing, the rounded cosine can have the wrong sign; the side is known from the boundary.
    const double rounded = dot(hit.normal, to_viewer);
    const double cos_view = hit.entering ? greatest(rounded, smallest) : least(rounded, -smallest);
    Vec3d color = state_.lights.empty() ? hit.color : Vec3d{};
    for (std::size_t i = 0; i < state_.lights.size(); ++i) {
      const Vec3d added = state_.lights[i].intensity * lit(hit, to_viewer, cos_view, state_.lights[i]);
      observer.lit(i, state_.lights[i], added);
      color += added;
    }
    if (depth >= state_.settings.max_depth) {
      observer.depth_reached();
      return color;
    }

    const Material& material = *hit.material;
    if (state_.settings.reflections) {
      const double weight = mirror_weight(hit, to_viewer, cos_view);
      if (goes_on(importance * weight)) {
        observer.begin(weight);
        const Ray next = ray_from(hit, mirrored_at(hit, ray), hit.entering);
        color += radiance<RayKind::reflected>(next, depth + 1, importance * weight) * weight;
      } else {
        observer.not_traced(RayKind::reflected, weight, NotTraced::importance);
      }
    }
    if (state_.settings.refractions) {
      const double weight = material.transmission;
      if (!goes_on(importance * weight)) {
        observer.not_traced(RayKind::refracted, weight, NotTraced::importance);
      } else if (const std::optional<Vec3d> direction = refracted_at(hit, ray)) {
        observer.begin(weight);
        const Ray next = ray_from(hit, *direction, !hit.entering);
        color += radiance<RayKind::refracted>(next, depth + 1, importance * weight) * weight;
      } else {
        observer.not_traced(RayKind::refracted, weight, NotTraced::total_reflection);
      }
    }
    return color;
  }

  // An interpolated normal may lean over so far that light would go to the wrong side of the triangle. There, the
  // triangle's own normal counts.
  Vec3d mirrored_at(const Hit& hit, const Ray& ray) const {
    const Vec3d direction = mirrored(-ray.direction, hit.normal);
    if (hit.part == no_part) return direction;
    const Vec3d facet = facet_normal(state_.world, ray, hit);
    return (dot(direction, facet) > 0) == hit.entering ? direction : mirrored(-ray.direction, facet);
  }
  std::optional<Vec3d> refracted_at(const Hit& hit, const Ray& ray) const {
    const std::optional<Vec3d> direction = refracted(-ray.direction, hit.normal, hit.index);
    if (hit.part == no_part || !direction) return direction;
    const Vec3d facet = facet_normal(state_.world, ray, hit);
    return (dot(*direction, facet) < 0) == hit.entering ? direction
                                                        : refracted(-ray.direction, facet, hit.index);
  }

  static double mirror_weight(const Hit& hit, const Vec3d& to_viewer, double cos_view) {
    const PhongWeights k = phong_weights(*hit.material, hit.index, cos_view, hit.entering);
    // From a denser medium outside, total reflection takes what would go through. (Phong's weights know it only
    // from inside.)
    const bool is_total = hit.outer != unknown_medium && hit.entering && hit.index < 1 &&
                          !refracted(to_viewer, hit.normal, hit.index);
    return is_total ? least(k.specular + k.transmission, 1 - k.diffuse) : k.specular;
  }

  /// A ray that adds nothing is not traced, whatever the limit says.
  bool goes_on(double importance) const {
    return importance > 0 && importance >= state_.settings.min_importance;
  }

  /// What a light sends to the viewer, as a factor of its intensity.
  Vec3d lit(const Hit& hit, const Vec3d& to_viewer, double cos_view, const SampledLight& light) {
    if (light.is_ambient) return phong_ambient(*hit.material, hit.color, cos_view > 0);
    const Vec3d to_light = light.at - hit.point;
    if (!(dot(to_light, hit.normal) > 0)) return {};
    if (state_.settings.shadows) {
      const RayQuery query(ray_from(hit, to_light, true));
      const bool blocked = is_blocked(state_.world, query, state_.workspace);
      observer.shadow_tested(query.ray, blocked);
      if (blocked) return {};
    }
    const double distance = length(to_light);
    const Vec3d direct = phong(*hit.material, hit.index, hit.color, hit.normal, to_viewer, cos_view,
                               to_light * (1 / distance));
    if (!light.dimmed) return direct;
    const glm::dvec3& dim = light.dimmed->dim;
    return direct * (1 / (dim[0] + dim[1] * distance + dim[2] * distance * distance));
  }

  static constexpr double smallest = std::numeric_limits<double>::denorm_min();

  State state_;
};

}  // namespace rayfarm
