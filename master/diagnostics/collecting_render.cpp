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
  if (!cloud_ && maps_.empty()) return rayfarm::render_tile(world_, settings_, tile, passes, stop);
  if (!cloud_) return render_passes_by(Tracer<CountingObserver>(world_, settings_), tile, passes, stop);
  CloudPart part(*cloud_, ranks_[tile]);
  Images images = render_passes_by(Tracer<WithCloud<CountingObserver>>(world_, settings_, {{}, &part}), tile,
                                   passes, stop);
  if (images)
    part.end();
  else
    cloud_->give_up();
  return images;
}

template <class Tracer>
CollectingRender::Images CollectingRender::render_passes_by(Tracer tracer, std::uint32_t tile, PassSet passes,
                                                            const std::function<bool()>& stop) {
  if (maps_.empty())
    return render_passes(tracer, settings_, tile, passes,
                         [&](Pixel pixel) { return pixel_sum(tracer, settings_, pixel, stop); });
  PixelWatch watch(world_, settings_, Reduction::majority);
  tracer.watch_primary_rays(&watch);
  Stopwatch stopwatch(is_timed_);
  return render_passes(tracer, settings_, tile, passes, [&](Pixel pixel) {
    const std::size_t place = std::size_t{pixel.y} * settings_.width + pixel.x;
    fetch_all(place, into_);
    watch.begin_pixel(tracer.observer.counters);
    std::optional<PixelSum> sum = watched_sum(tracer, settings_, pixel, stop, watch);
    if (!sum) return sum;
    PixelFacts facts = watch.facts(tracer.observer.counters);
    facts.seconds = stopwatch.lap();
    put_all(facts, view_, place, into_);
    return sum;
  });
}

}  // namespace rayfarm
