#include "master/diagnostics/collecting_render.h"

#include "common/render/render.h"
#include "common/render/render_passes.h"
#include "master/diagnostics/collect.h"
#include "master/diagnostics/ticks.h"

namespace rayfarm {
namespace {

/// The cost of a pixel is what has passed since the one before; who wants no cost does not look at it.
class Stopwatch {
 public:
  explicit Stopwatch(bool runs) : rate_(runs ? seconds_per_tick() : 0) { lap(); }
  double lap() {
    if (rate_ == 0) return 0;
    const std::int64_t before = last_;
    last_ = ticks();
    return rate_ * static_cast<double>(last_ - before);
  }

 private:
  double rate_;
  std::int64_t last_ = 0;
};

/// Puts the maps' values of each pixel.
class MapsWatch final : public SurfaceWatch {
 public:
  MapsWatch(const World& world, const RenderSettings& settings, const MapView& view,
            std::span<float* const> into, bool is_timed)
      : SurfaceWatch(world, settings, Reduction::majority),
        width_(settings.width),
        view_(view),
        into_(into),
        stopwatch_(is_timed) {}

  void pixel_ended(Pixel pixel, const RayCounters& counters) override {
    PixelFacts known = facts(counters);
    known.seconds = stopwatch_.lap();
    put_all(known, view_, std::size_t{pixel.y} * width_ + pixel.x, into_);
  }

 private:
  std::size_t width_;
  const MapView& view_;
  std::span<float* const> into_;
  Stopwatch stopwatch_;
};

}  // namespace

CollectingRender::CollectingRender(const World& world, const RenderSettings& settings,
                                   const std::vector<const MapKind*>& maps)
    : world_(world), settings_(settings), view_(view_of(world, settings, false)), into_(all_maps().size()) {
  const std::size_t pixels = std::size_t{settings.width} * settings.height;
  for (const MapKind* kind : maps) {
    is_timed_ = is_timed_ || kind->source == MapSource::time;
    maps_.push_back({{settings.width, settings.height}, kind->channels.size(), {}});
    maps_.back().values.resize(pixels * kind->channels.size());
    into_[static_cast<std::size_t>(kind - all_maps().data())] = maps_.back().values.data();
  }
}

void CollectingRender::also_collect(CloudFile& cloud) {
  cloud_ = &cloud;
  const std::vector<std::uint32_t> order = centre_first({settings_.width, settings_.height});
  ranks_.resize(order.size());
  for (std::uint32_t rank = 0; rank < order.size(); ++rank) ranks_[order[rank]] = rank;
}

CollectingRender::Images CollectingRender::render_tile(std::uint32_t tile, PassSet passes,
                                                       const std::function<bool()>& stop) {
  std::optional<MapsWatch> watch;
  if (!maps_.empty()) watch.emplace(world_, settings_, view_, into_, is_timed_);
  PixelWatch* const watching = watch ? &*watch : nullptr;
  if (!cloud_) return rayfarm::render_tile(world_, settings_, tile, passes, stop, watching);
  CloudPart part(*cloud_, ranks_[tile]);
  Tracer<WithCloud<CountingObserver>> tracer(world_, settings_, {{}, &part});
  tracer.set_watch(watching);
  Images images =
      render_passes(tracer, settings_, tile_at({settings_.width, settings_.height}, tile), passes, stop);
  if (images)
    part.end();
  else
    cloud_->give_up();
  return images;
}

}  // namespace rayfarm
