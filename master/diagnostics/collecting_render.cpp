#include "master/diagnostics/collecting_render.h"

#include <chrono>

#include "common/render/render.h"
#include "common/render/render_passes.h"
#include "master/diagnostics/collect.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

/// The cost of a pixel is what the clock says since the one before; who wants no cost does not look at it.
class Stopwatch {
 public:
  explicit Stopwatch(bool runs) : runs_(runs) { lap(); }
  double lap() {
    if (!runs_) return 0;
    const Clock::time_point before = last_;
    last_ = Clock::now();
    return std::chrono::duration<double>(last_ - before).count();
  }

 private:
  bool runs_;
  Clock::time_point last_;
};

}  // namespace

CollectingRender::CollectingRender(const World& world, const RenderSettings& settings,
                                   const std::vector<const MapKind*>& maps)
    : world_(world), settings_(settings), view_(view_of(world, settings, false)) {
  const std::size_t pixels = std::size_t{settings.width} * settings.height;
  for (const MapKind* kind : maps) {
    is_timed_ = is_timed_ || kind->source == MapSource::time;
    maps_.push_back({{settings.width, settings.height}, kind->channels.size(), {}});
    maps_.back().values.resize(pixels * kind->channels.size());
    outlets_.push_back({kind->put, maps_.back().values.data(), kind->channels.size()});
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
  if (!cloud_ && outlets_.empty()) return rayfarm::render_tile(world_, settings_, tile, passes, stop);
  const PixelObserver pixels(world_, settings_, Reduction::majority);
  if (!cloud_) return render_maps(pixels, tile, passes, stop);

  CloudPart part(*cloud_, ranks_[tile]);
  Images images;
  if (outlets_.empty()) {
    Tracer<WithCloud<CountingObserver>> tracer(world_, settings_, {{}, &part});
    images = render_passes(tracer, settings_, tile, passes,
                           [&](Pixel pixel) { return pixel_sum(tracer, settings_, pixel, stop); });
  } else {
    images = render_maps(WithCloud<PixelObserver>{pixels, &part}, tile, passes, stop);
  }
  if (images)
    part.end();
  else
    cloud_->give_up();
  return images;
}

template <class Observer>
CollectingRender::Images CollectingRender::render_maps(Observer observer, std::uint32_t tile, PassSet passes,
                                                       const std::function<bool()>& stop) {
  Tracer<Observer> tracer(world_, settings_, std::move(observer));
  Stopwatch watch(is_timed_);
  return render_passes(tracer, settings_, tile, passes, [&](Pixel pixel) {
    tracer.observer.begin_pixel();
    std::optional<PixelSum> sum{std::in_place};
    const bool complete = visit_samples(tracer, settings_, pixel, stop, [&](const TakenSample& sample) {
      sum->add(sample.color, sample.weight);
      tracer.observer.visited(sample);
    });
    if (!complete) return std::optional<PixelSum>();
    PixelFacts facts = tracer.observer.facts();
    facts.seconds = watch.lap();
    put(pixel, facts);
    return sum;
  });
}

void CollectingRender::put(Pixel pixel, const PixelFacts& facts) {
  const std::size_t place = std::size_t{pixel.y} * settings_.width + pixel.x;
  for (const Outlet& outlet : outlets_) outlet.put(facts, view_, outlet.values + place * outlet.channels);
}

}  // namespace rayfarm
