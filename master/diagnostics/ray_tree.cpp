#include "master/diagnostics/ray_tree.h"

namespace rayfarm {
namespace {

class Recorder : public IdleObserver {
 public:
  explicit Recorder(const World& world) : world_(&world.parts()) {}

  void begin(double weight) { open_.emplace_back().weight = weight; }
  void traced(RayKind kind, const Ray& ray, std::uint32_t depth, double importance,
              const std::optional<Hit>& hit) {
    RayRecord& record = open_.back();
    record.kind = kind, record.depth = depth, record.importance = importance;
    record.origin = ray.origin, record.direction = ray.direction;
    if (hit)
      record.hit = {
          hit->t * length(ray.direction), hit->point, hit->normal, hit->color, hit->leaf, hit->entering};
  }
  void shadow_tested(const Ray& ray, bool blocked) {
    shadow_ = {blocked, std::nullopt};
    if (!blocked) return;
    const RayQuery query(ray);
    if (const auto first = first_boundary(*world_, query, workspace_); first && first->t <= 1)
      shadow_.blocker = Blocker{first->leaf, hit_at(*world_, query, *first).point};
  }
  void lit(std::size_t light, const SampledLight& sampled, const Vec3d& color) {
    open_.back().lights.push_back({light, fate_of(sampled), sampled.at, color, shadow_.blocker});
    shadow_ = {};
  }
  void not_traced(RayKind kind, double weight, NotTraced why) {
    if (weight > 0) open_.back().untraced.push_back({kind, weight, why});
  }
  void depth_reached() { open_.back().depth_reached = true; }
  void ended(const Vec3d& color) {
    open_.back().color = color;
    RayRecord record = std::move(open_.back());
    open_.pop_back();
    if (open_.empty())
      root = std::move(record);
    else
      open_.back().followed.push_back(std::move(record));
  }

  RayRecord root;

 private:
  LightFate fate_of(const SampledLight& light) const {
    if (light.is_ambient) return LightFate::ambient;
    if (shadow_.blocked) return LightFate::blocked;
    const RayHit& hit = *open_.back().hit;
    return dot(light.at - hit.point, hit.normal) > 0 ? LightFate::reached : LightFate::behind;
  }

  struct Shadow {
    bool blocked = false;
    std::optional<Blocker> blocker;
  };

  const World::Parts* world_;
  WorldWorkspace workspace_;
  std::vector<RayRecord> open_;  // from the primary ray to the one being traced
  Shadow shadow_;                // of the light that comes next
};

}  // namespace

TracedSample traced_sample(const World& world, const RenderSettings& settings, Pixel pixel,
                           std::uint32_t number) {
  Tracer<Recorder> tracer(world, settings, Recorder(world));
  const PixelSampler sampler(settings, pixel);
  const Sample2D at = taken_sample(tracer, sampler, pixel, number).at;
  return {number, pixel.x + at.u, pixel.y + at.v, std::move(tracer.observer.root)};
}

TracedSample traced_centre(const World& world, const RenderSettings& settings, Pixel pixel) {
  Tracer<Recorder> tracer(world, settings, Recorder(world));
  const double x = pixel.x + 0.5, y = pixel.y + 0.5;
  tracer.radiance(x, y, [](std::uint32_t) { return Sample2D{0.5, 0.5}; });
  return {std::nullopt, x, y, std::move(tracer.observer.root)};
}

}  // namespace rayfarm
