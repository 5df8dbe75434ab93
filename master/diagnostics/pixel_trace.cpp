#include "master/diagnostics/pixel_trace.h"

namespace rayfarm {
namespace {

/// Ray number `number` of the tree, the parents before their children; counts `number` down.
const RayRecord* ray_numbered(const RayRecord& root, std::uint32_t& number) {
  if (number == 0) return &root;
  --number;
  for (const RayRecord& followed : root.followed)
    if (const RayRecord* found = ray_numbered(followed, number)) return found;
  return nullptr;
}

const RayRecord& story_ray_of(const RayRecord& root, std::uint32_t number) {
  std::uint32_t left = number;
  if (const RayRecord* found = ray_numbered(root, left)) return *found;
  throw SettingsError("the sample has " + std::to_string(number - left) +
                      " rays, numbered from 0; there is no ray " + std::to_string(number));
}

}  // namespace

PixelTrace pixel_trace(const World& world, LeafNames leaf_names, const RenderSettings& settings, Pixel pixel,
                       const SampleChoice& choice, std::uint32_t story_ray, const RecordLimits& limits) {
  if (story_ray > 0 && std::holds_alternative<EverySample>(choice))
    throw SettingsError("ray " + std::to_string(story_ray) +
                        " is one of a sample's rays; name the sample, too");
  TracedSamples traced = traced_samples(world, settings, pixel, choice, limits);
  PixelTrace trace{pixel, {}, std::move(leaf_names), traced.truncated};
  for (TracedSample& sample : traced.samples) {
    CsgStory story = csg_story(world, story_ray_of(sample.ray, story_ray).path);
    trace.samples.push_back({std::move(sample), story_ray, std::move(story)});
  }
  return trace;
}

}  // namespace rayfarm
