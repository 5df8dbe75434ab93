#include "master/diagnostics/ray_tree.h"

#include <charconv>

#include "common/math/overload.h"

namespace rayfarm {
namespace {

/// Records trees until there are too many rays, or somebody says stop: then it is closed, and hears no more.
class Recorder : public IdleObserver {
 public:
  Recorder(const World& world, const RecordLimits& limits) : world_(&world.parts()), limits_(&limits) {}

  void begin(double weight) {
    if (!closed_) open_.emplace_back().record.weight = weight;
  }
  void traced(RayKind kind, const Ray& ray, std::uint32_t depth, double importance,
              const std::optional<Hit>& hit) {
    if (!take_place()) return;
    open_.back().is_traced = true;
    RayRecord& record = open_.back().record;
    record.kind = kind, record.depth = depth, record.importance = importance;
    record.path = ray;
    if (hit)
      record.hit = {
          hit->t * length(ray.direction), hit->point, hit->normal, hit->color, hit->leaf, hit->entering};
  }
  void shadow_tested(const Ray& ray, bool blocked) {
    if (!take_place()) return;
    shadow_ = {blocked, std::nullopt};
    if (!blocked) return;
    const RayQuery query(ray);
    if (const auto first = first_blocker(*world_, query, workspace_))
      shadow_.blocker = Blocker{first->leaf, hit_at(*world_, query, *first).point};
  }
  void lit(std::size_t light, const SampledLight& sampled, const Vec3d& color) {
    if (closed_) return;
    record().lights.push_back({light, fate_of(sampled), sampled.at, color, shadow_.blocker});
    shadow_ = {};
  }
  void not_traced(RayKind kind, double weight, NotTraced why) {
    if (!closed_ && weight > 0) record().untraced.push_back({kind, weight, why});
  }
  void depth_reached() {
    if (!closed_) record().depth_reached = true;
  }
  void glowed(std::size_t glow, const Vec3d& color) {
    if (!closed_) record().glows.push_back({glow, color});
  }
  void no_ray() {
    if (!closed_) roots_.emplace_back();
  }
  void ended(const Vec3d& color) {
    if (closed_) return;
    record().color = color;
    hand_up();
  }

  /// Asked by the tracer between begin() and traced().
  bool must_stop() {
    closed_ = closed_ || (limits_->stop && limits_->stop());
    return closed_;
  }
  /// The samples' trees in their order, nothing where there was no ray; of the last one of a closed recorder, what
  /// there is of it.
  std::vector<std::optional<RayRecord>> take_roots() {
    while (!open_.empty())
      if (open_.back().is_traced)
        hand_up();
      else
        open_.pop_back();
    return std::move(roots_);
  }
  bool is_closed() const { return closed_; }

 private:
  /// A ray that has begun. It is not traced when the tracer stops.
  struct Open {
    RayRecord record;
    bool is_traced = false;
  };
  struct Shadow {
    bool blocked = false;
    std::optional<Blocker> blocker;
  };

  RayRecord& record() { return open_.back().record; }
  bool take_place() {
    closed_ = closed_ || rays_ == limits_->rays;
    if (!closed_) ++rays_;
    return !closed_;
  }
  void hand_up() {
    RayRecord done = std::move(record());
    open_.pop_back();
    if (open_.empty())
      roots_.push_back(std::move(done));
    else
      record().followed.push_back(std::move(done));
  }
  LightFate fate_of(const SampledLight& light) {
    if (light.is_ambient) return LightFate::ambient;
    if (shadow_.blocked) return LightFate::blocked;
    const RayHit& hit = *record().hit;
    return dot(light.at - hit.point, hit.normal) > 0 ? LightFate::reached : LightFate::behind;
  }

  const World::Parts* world_;
  const RecordLimits* limits_;
  WorldWorkspace workspace_;
  std::size_t rays_ = 0;
  bool closed_ = false;
  std::vector<std::optional<RayRecord>> roots_;
  std::vector<Open> open_;  // from the primary ray to the one being traced
  Shadow shadow_;           // of the light that comes next
};

[[noreturn]] void refuse_sample(const std::string& wanted, std::uint32_t samples) {
  throw SettingsError("the sample must be a number from 0 to " + std::to_string(samples - 1) +
                      ", all or centre, is " + wanted);
}

/// One pixel's samples being recorded.
struct Recording {
  Recording(const World& world, const RenderSettings& settings, Pixel pixel, const RecordLimits& limits)
      : settings(settings), pixel(pixel), tracer(world, settings, Recorder(world, limits)) {}

  const RenderSettings& settings;
  const Pixel pixel;
  Tracer<Recorder> tracer;
  std::vector<TracedSample> samples;  // without their rays yet

  bool must_stop() { return tracer.observer.must_stop(); }
  void note(const TakenSample& sample) {
    samples.push_back({sample.number, pixel.x + sample.at.u, pixel.y + sample.at.v, sample.weight, {}});
  }
  void add_all() {
    visit_samples(
        tracer, settings, pixel, [this] { return must_stop(); },
        [this](const TakenSample& sample) { note(sample); });
  }
  void add_one(std::uint32_t number) {
    tracer.stop_when([this] { return must_stop(); });
    note(taken_sample(tracer, PixelSampler(settings, pixel), pixel, number));
  }
  void add_centre() {
    tracer.stop_when([this] { return must_stop(); });
    const double x = pixel.x + 0.5, y = pixel.y + 0.5;
    tracer.radiance(x, y, [](std::uint32_t) { return Sample2D{0.5, 0.5}; });
    samples.push_back({std::nullopt, x, y, 1, {}});
  }
  /// Of all of an adaptive sampler's, which are known only when all are traced, `only` one may be wanted.
  TracedSamples finish(std::optional<std::uint32_t> only) {
    std::vector<std::optional<RayRecord>> roots = tracer.observer.take_roots();
    const bool truncated = tracer.observer.is_closed();
    const std::size_t there =
        std::min(samples.size(), roots.size());  // the last may have been stopped at once
    if (only && *only >= there && !truncated)
      refuse_sample(std::to_string(*only), static_cast<std::uint32_t>(there));
    TracedSamples traced{{}, truncated};
    for (std::size_t i = 0; i < there; ++i) {
      if (!roots[i] || (only && *only != i)) continue;
      samples[i].ray = std::move(*roots[i]);
      traced.samples.push_back(std::move(samples[i]));
    }
    return traced;
  }
};

void check_pixel(Pixel pixel, const RenderSettings& s) {
  const auto text = [](std::uint32_t x, std::uint32_t y) {
    return std::to_string(x) + "," + std::to_string(y);
  };
  if (pixel.x >= s.width || pixel.y >= s.height)
    throw SettingsError("the pixel " + text(pixel.x, pixel.y) + " lies outside the picture of " +
                        std::to_string(s.width) + "x" + std::to_string(s.height) + "; the last pixel is " +
                        text(s.width - 1, s.height - 1));
}

}  // namespace

SampleChoice sample_choice(const std::string& text, const RenderSettings& settings) {
  if (text == "all") return EverySample{};
  if (text == "centre") return PixelCentre{};
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::uint32_t most = pixel_weight(settings);
  if (error != std::errc{} || end != text.data() + text.size() || number >= most) refuse_sample(text, most);
  return number;
}

TracedSamples traced_samples(const World& world, const RenderSettings& settings, Pixel pixel,
                             const SampleChoice& choice, const RecordLimits& limits) {
  check_pixel(pixel, settings);
  Recording recording(world, settings, pixel, limits);
  const auto* number = std::get_if<std::uint32_t>(&choice);
  if (number && *number >= pixel_weight(settings))
    refuse_sample(std::to_string(*number), pixel_weight(settings));
  const bool is_one = number && !is_adaptive(settings.sampler);
  std::visit(
      Overload{[&](std::uint32_t n) { is_one ? recording.add_one(n) : recording.add_all(); },
               [&](EverySample) { recording.add_all(); }, [&](PixelCentre) { recording.add_centre(); }},
      choice);
  return recording.finish(number && !is_one ? std::optional(*number) : std::nullopt);
}

}  // namespace rayfarm
