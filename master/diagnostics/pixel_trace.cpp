#include "master/diagnostics/pixel_trace.h"

namespace rayfarm {

PixelTrace pixel_trace(const World& world, LeafNames leaf_names, const RenderSettings& settings, Pixel pixel,
                       const SampleChoice& choice, const RecordLimits& limits) {
  TracedSamples traced = traced_samples(world, settings, pixel, choice, limits);
  PixelTrace trace{pixel, {}, std::move(leaf_names), traced.truncated};
  for (TracedSample& sample : traced.samples) {
    CsgStory story = csg_story(world, {sample.ray.origin, sample.ray.direction});
    trace.samples.push_back({std::move(sample), std::move(story)});
  }
  return trace;
}

}  // namespace rayfarm
